"""`python -m tests.bench`: one table of times on one core, each beside references measured in the same run."""

import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gpsynth.arrays import Floats
from gpsynth.evaluate import Evaluator
from tests.bench.compiled import compile_setting
from tests.bench.dense_network import NOM_461, network_rows
from tests.bench.elementary import elementary_rows
from tests.bench.fresh_plant import fresh_plant_row
from tests.bench.measure import machine, median_time, pin
from tests.bench.peers import deap_laws, roll
from tests.bench.setting import LAWS, OPERATIONS_A_LAW, STARTS, STEPS, Setting, setting, unicycle

LIMIT = "C++ 8-wide, law compiled: the SIMD limit"
STRICT = "the same, strict IEEE (no FMA contraction)"
DEFAULT = "gpsynth, blocks of 128"
COMPILED = (
    (LIMIT, "Own<8>", ()),
    (STRICT, "Own<8>", ("-ffp-contract=off",)),
    ("C++ 4-wide, law compiled", "Own<4>", ()),
    ("C scalar, law compiled, own polynomials", "Own<1>", ()),
    ("C scalar, law compiled, libm", "Libm", ()),
)
BLOCKS = (16, 64, 128, 256, 512)
RELATIVE = 1e-9
LEAST_SHARE = 0.9  # laws that divide can chatter across a jump, where one rounding decides the path


class Row(NamedTuple):
    """What one evaluator reached."""

    name: str
    rate: float  # rollouts per second
    costs: Floats | None = None  # (laws, starts)
    compiling: float = np.nan  # s a law


def main() -> None:
    """Measure and print."""
    pin()
    case = setting()
    print(machine())
    print(
        f"closed loop: unicycle, RK4, {STEPS} steps, law at each stage; {LAWS} laws of {OPERATIONS_A_LAW} operations"
    )
    rows = [*_compiled(case), *(_interpreted(case, block) for block in BLOCKS), *_peers(case)]
    _print(rows)
    if NOM_461.exists():
        law, found = network_rows(case)
        print(
            f"\n{f'network operator NOM-461, {law.complexity} operations, same loop':56}{'rollouts/s':>12}{'ratio':>9}"
        )
        for name, rate in found:
            print(f"{name:56}{rate:12,.0f}{rate / found[0][1]:9.1f}")
    print(f"\n{'ns per element':56}{'gpsynth':>12}{'numpy':>9}{'ratio':>9}")
    for name, ours, theirs in elementary_rows():
        print(f"{name:56}{ours:12.2f}{theirs:9.2f}{theirs / ours:9.2f}")
    label, seconds = fresh_plant_row()
    print(f"\n{label:56}{seconds:12.2f} s")


def _compiled(case: Setting) -> Iterator[Row]:
    with tempfile.TemporaryDirectory() as folder:
        for k, (name, operations, flags) in enumerate(COMPILED):
            begin = time.perf_counter()
            library = compile_setting(case, operations, Path(folder) / f"laws{k}", flags)
            compiling = (time.perf_counter() - begin) / LAWS
            seconds, costs = median_time(lambda library=library: library.costs(case.problem.starts))
            yield Row(name, costs.size / seconds, costs, compiling)


def _interpreted(case: Setting, block: int) -> Row:
    count = max(block, STARTS)
    evaluator = Evaluator(
        unicycle(case.starts[:count]), block=block
    )  # as many starts as a block has lanes, or STARTS
    none = np.empty((1, 0))
    seconds, costs = median_time(lambda: [evaluator.of_program(law, none).cost[0] for law in case.laws])
    return Row(f"gpsynth, blocks of {block}", len(case.laws) * count / seconds, np.array(costs))


def _peers(case: Setting) -> Iterator[Row]:
    laws = deap_laws(case)
    for count in (1024, 64, 16):
        some = laws if count == STARTS else laws[:8]
        starts = case.starts[:count]
        seconds, costs = median_time(lambda some=some, starts=starts: [roll(law, starts) for law in some])
        whole = np.array(costs) if count == STARTS else None
        yield Row(f"DEAP functions, numpy RK4, {count} starts at once", len(some) * count / seconds, whole)


def _print(rows: list[Row]) -> None:
    rates = {row.name: row.rate for row in rows}
    scalar = max(rate for name, rate in rates.items() if name.startswith("C scalar"))
    reference = rows[0].costs
    assert reference is not None
    print(f"\n{'':56}{'rollouts/s':>12}{'/scalar':>9}{'/limit':>9}{'agree':>9}")
    for row in rows:
        agreement = "" if row.costs is None else f"{_agreement(row, reference):9.1%}"
        print(
            f"{row.name:56}{row.rate:12,.0f}{row.rate / scalar:9.2f}{row.rate / rates[LIMIT]:9.3f}{agreement}"
        )
    compiled, ours = (next(row for row in rows if row.name == name) for name in (STRICT, DEFAULT))
    saved = 1.0 / ours.rate - 1.0 / compiled.rate  # s a rollout
    pays = f"pays from {compiled.compiling / saved:,.0f} rollouts on" if saved > 0.0 else "never pays"
    print(f"compiling a law that way takes {compiled.compiling:.2f} s and {pays}")
    print("Kozax is not measured: its licence, CC BY-NC-ND, keeps code for it out of this repository")


def _agreement(row: Row, reference: Floats) -> float:
    """The share of rollouts whose costs agree to RELATIVE."""
    assert row.costs is not None
    apart = np.abs(row.costs[:, : reference.shape[1]] - reference)
    share = float(np.mean(apart <= RELATIVE * np.abs(reference)))
    if share < LEAST_SHARE:
        raise SystemExit(f"{row.name}: {1 - share:.1%} of the costs differ from the reference")
    return share


if __name__ == "__main__":
    main()
