"""The command line that all examples share: search from scratch, print fronts and reference, write the exports."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

import click

import gpsynth as gs
from gpsynth.command_line import run
from gpsynth.export import write
from gpsynth.files import make_folder
from gpsynth.synthesis import FrontEntry

ENOUGH = 10_000  # evaluations, for islands


@dataclass(frozen=True, eq=False)
class Finding:
    """What a seed found: fronts by name, the last for `problem`, the others for parts of its plant or features."""

    problem: gs.Problem
    results: Mapping[str, gs.SynthesisResult]

    @property
    def best(self) -> FrontEntry:
        """The law that the example is about."""
        return list(self.results.values())[-1].best


def islands(budget: int) -> gs.Islands | None:
    """Four searches side by side that merge, so that little hangs on the seed; a single one where a budget is short."""
    return gs.Islands(4) if budget >= ENOUGH else None


def command(
    found: Callable[[int, int, int], Finding], *, budget: int, tuning: int, reference: str, seed: int = 1
) -> click.Command:
    """`FOLDER [--seed] [--budget] [--tuning]`: fronts, cost and reference are printed, exports written to FOLDER."""

    @click.command()
    @click.argument("folder", type=click.Path(path_type=Path))
    @click.option("--seed", default=seed, show_default=True, help="Of all randomness.")
    @click.option("--budget", default=budget, show_default=True, help="Evaluations of the search.")
    @click.option(
        "--tuning", default=tuning, show_default=True, help="Evaluations for each law of the front."
    )
    def main(folder: Path, seed: int, budget: int, tuning: int) -> None:
        """Find laws from scratch and write the best one's exports to FOLDER."""
        make_folder(folder)  # what cannot be written is not worth a search
        finding = found(seed, budget, tuning)
        paths = []
        for name, result in finding.results.items():
            print(result.table())
            paths += write(result.law, folder, name)
        best = finding.best
        print(f"cost {best.cost:.6g}, {best.reached:.0%} of the starts end at the goal; {reference}")
        for path in paths:
            print(path)

    return main


def start(main: click.Command, name: str) -> None:
    """Run an example's command line as a program."""
    raise SystemExit(run(main, name=f"python -m examples.{name}"))
