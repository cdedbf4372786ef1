"""`python -m tests.bench.growth`: how the time of rollouts grows with operations, lanes and steps; where it goes.

The tables are of a law without elementary functions, whose operations cost about the same. "us more" is the slope from
the row above: constant where the growth is linear.
"""

import time
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from applications.rosbot.stabilizer import default_law, poses, stabilization
from gpsynth.builder import Builder
from gpsynth.evaluate import Evaluator
from gpsynth.kernels import machine, rollout
from gpsynth.kernels.pack import pack
from gpsynth.loop_arrays import instructions
from gpsynth.program import Program
from gpsynth.seeds import stream
from tests.bench.measure import machine as processor
from tests.bench.measure import pin
from tests.bench.setting import HORIZON, STEPS, Setting, setting, unicycle

STAGES = 4 * STEPS
OPERATIONS = (20, 40, 80, 160, 320)
LANES = (8, 16, 32, 64, 128, 256, 512, 1024)
FACTORS = (1, 2, 4, 8)  # of the horizon
BASE = (40, 128)  # operations and lanes where they are not what varies
REPEATS = 15
_NONE = np.empty((1, 0))


def main() -> None:
    """Measure and print."""
    pin()
    print(processor())
    case = setting()
    for title, rows in (
        (f"operations; {BASE[1]} lanes, {STEPS} steps", by_operations(case)),
        (f"lanes; {BASE[0]} operations, {STEPS} steps", by_lanes(case)),
        (f"steps; {BASE[0]} operations, {BASE[1]} lanes", by_steps(case)),
    ):
        print(f"\n{title:44}{'ms':>10}{'us each':>10}{'us more':>10}")
        before = None
        for count, seconds in rows:
            more = f"{1e6 * (seconds - before[1]) / (count - before[0]):10.2f}" if before else ""
            print(f"{count:44}{1e3 * seconds:10.3f}{1e6 * seconds / count:10.2f}{more}")
            before = count, seconds
    print(f"\n{'ns per lane and stage; laws of 20 operations':44}{'64 lanes':>10}{'128':>10}")
    for name, shares in zip(
        PARTS, zip(*(parts(case, lanes) for lanes in (64, 128)), strict=True), strict=True
    ):
        print(f"{name:44}{shares[0]:10.2f}{shares[1]:10.2f}")
    leaving, staying = endings()
    print(f"\n{'ms; 1024 poses of the ROSbot, its law':44}{1e3 * leaving:10.2f}")
    print(f"{'the same with all lanes running to the last':44}{1e3 * staying:10.2f}")


def by_operations(case: Setting) -> Iterator[tuple[int, float]]:
    """Operations of the law, and the time (s) of its rollouts."""
    for count in OPERATIONS:
        yield count, _time(case, _law(case, count), BASE[1], HORIZON)


def by_lanes(case: Setting) -> Iterator[tuple[int, float]]:
    """Starts, and the time (s) of a rollout from each."""
    for count in LANES:
        yield count, _time(case, _law(case, BASE[0]), count, HORIZON)


def by_steps(case: Setting) -> Iterator[tuple[int, float]]:
    """Integration steps, and the time (s) of the rollouts."""
    for factor in FACTORS:
        yield factor * STEPS, _time(case, _law(case, BASE[0]), BASE[1], factor * HORIZON)


PARTS = (
    "features and law",
    "limits, rates and running cost",
    "arrival test",
    "Runge-Kutta, judging",
    "before and after",
)


def parts(case: Setting, lanes: int) -> tuple[float, ...]:
    """ns that each of PARTS takes; the instructions by themselves, the rest as what is left."""
    evaluator = Evaluator(unicycle(case.starts[:lanes]), block=lanes)
    none = replace(evaluator, problem=replace(evaluator.problem, horizon=evaluator.problem.period))
    whole, short = (
        _least(lambda each=each: [each.of_program(law, _NONE) for law in case.laws])
        for each in (evaluator, none)
    )
    packed = [pack(evaluator.frame, instructions(law), 0) for law in case.laws]
    workspace = rollout.workspace(max(rows.total for rows, _ in packed), lanes)
    workspace[:] = 0.5
    idle = _execute(packed, workspace, lambda ends: (0, 0))
    law = _execute(packed, workspace, lambda ends: (0, ends[0])) - idle
    rates = _execute(packed, workspace, lambda ends: (ends[0], ends[1])) - idle
    arrival = (_execute(packed, workspace, lambda ends: (ends[1], ends[2])) - idle) / 4  # once in four stages
    scale = 1e9 / (len(case.laws) * lanes * STAGES)
    rest = (whole - short) * scale * STEPS / (STEPS - 1) - (law + rates + arrival)
    return law, rates, arrival, rest, short * scale


def endings() -> tuple[float, float]:
    """Times (s) of rollouts that end when they arrive, and of the same rollouts up to the latest arrival."""
    law, starts = default_law(), poses(stream(1), 1024)
    stopped = Evaluator(stabilization(starts))
    latest = float(stopped.of_program(law.program, law.parameters).end.max())
    kept = Evaluator(stabilization(starts, stop=False, horizon=latest))
    leaving, staying = (
        _least(lambda each=each: each.of_program(law.program, law.parameters)) for each in (stopped, kept)
    )
    return leaving, staying


def _execute(packed, workspace, part) -> float:
    """ns a lane of executing `part` of each packed law once."""
    lanes, repeats = workspace.shape[1], 20
    codes = [(code.instructions, part(code.ends.tolist())) for _, code in packed]

    def work() -> None:
        for code, bounds in codes:
            for _ in range(repeats):  # one law again and again, as in a rollout: branches are predicted
                machine.execute(code, *bounds, workspace, lanes)

    return 1e9 * _least(work) / (repeats * len(packed) * lanes)


def _least(work: Callable[[], object]) -> float:
    """The least processor time (s) of REPEATS runs after a first one: differences of times need steady ones."""
    work()
    times = []
    for _ in range(REPEATS):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return min(times)


def _time(case: Setting, law: Program, lanes: int, horizon: float) -> float:
    problem = replace(unicycle(case.starts[:lanes]), horizon=horizon)
    evaluator = Evaluator(problem, block=128)
    return _least(lambda: [evaluator.of_program(law, _NONE) for _ in range(8)]) / 8


def _law(case: Setting, operations: int) -> Program:
    """Sums and products in a chain, bounded so that no rollout diverges."""
    builder = Builder(case.problem.features.names)
    value = builder.inputs[0]
    for k in range(operations - 1):
        name = ("mul", "min", "sub", "max", "add")[k % 5]
        value = builder.apply(name, value, builder.inputs[k % 3])
    return builder.build([value, builder.apply("neg", builder.inputs[2])])


if __name__ == "__main__":
    main()
