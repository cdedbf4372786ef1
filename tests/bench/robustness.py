"""`python -m tests.bench.robustness`: what becomes of laws when the clock is finer and the plant is not the model.

First robot A (`tests.bench.robot_a`): the published network-operator laws beside one found here, with the published
step of 0.01 s, a tenth of it, other limits and noise. Then the ROSbot's dynamic model: the shipped law, which was found
on the kinematic one, and the hand-tuned polar law, from 1000 starts within 3 m, each under a draw of its own.
"""

import argparse
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

import gpsynth as gs
from applications.rosbot.model import DELAY, dynamic_unicycle, unicycle
from applications.rosbot.polar_law import polar_law
from applications.rosbot.stabilization import poses, stabilization
from applications.rosbot.stabilizer import default_law
from gpsynth.encodings.network_operator_matrix import Matrix, decode_matrix
from gpsynth.files import read_json
from gpsynth.verify.stress import noisy
from tests.bench import robot_a
from tests.bench.measure import median_time

GOLDEN = Path(__file__).parents[3] / "shared" / "golden"
PUBLISHED = {"NOM-461": "nom_461.json", "NOM-default": "nom_default.json"}
STARTS, SEED = 1000, 20_261_125
NOISE_A = (0.01, 0.01, 0.01)  # m, m, rad
NOISE = (0.01, 0.01, 0.02, 0.0, 0.0)  # m, m, rad: no law here sees the speeds


def published(path: Path) -> gs.Law:
    """A law of the robot whose matrix and numbers are in a file."""
    document, problem = read_json(path), robot_a.problem(0.01)
    nodes = (tuple(document[name]) for name in ("inputs", "parameters", "outputs"))
    matrix = Matrix(np.array(document["matrix"]), *nodes)
    program = decode_matrix(matrix, problem.features.names, problem.plant.control_names)
    return gs.Law(problem.plant, problem.features, program, np.array(document["q"], dtype=np.float64))


def rosbot() -> gs.Problem:
    """The dynamic robot, each start under a plant and a delay of its own."""
    plant = dynamic_unicycle()
    draws = gs.random_draws(plant, gs.stream(SEED, 1), STARTS, delay=DELAY)
    return stabilization(
        poses(gs.stream(SEED, 2), STARTS, 3.0), plant=plant, draws=draws, horizon=40.0, stop=False
    )


def overhead() -> float:
    """Time of rollouts under draws of everything over the time of as many with the nominal plant, to the horizon."""
    drawn = replace(rosbot(), horizon=10.0)
    full = noisy(drawn, NOISE)
    law = default_law()
    times = [
        median_time(partial(gs.Evaluator(each).of_program, law.program, law.parameters[np.newaxis]))[0]
        for each in (full, replace(drawn, draws=None))
    ]
    return times[0] / times[1]


def main() -> None:
    """Print one report a law."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seed", type=int, default=0, help="of the law that is found here")
    parser.add_argument("--budget", type=int, default=robot_a.BUDGET)
    arguments = parser.parse_args()
    problem = robot_a.problem(0.01)
    laws = {name: published(GOLDEN / file) for name, file in PUBLISHED.items() if (GOLDEN / file).exists()}
    laws[f"found here, seed {arguments.seed}"] = robot_a.synthesized(arguments.seed, arguments.budget).law
    for name, law in laws.items():
        print(
            f"robot A, {name}\n{gs.assess(law, problem, gs.Stress(noise=NOISE_A), threads=2).table()}\n",
            flush=True,
        )
    for name, law in {"shipped law": default_law(), "polar law": polar_law(unicycle())}.items():
        report = gs.assess(law, rosbot(), gs.Stress(noise=NOISE), threads=2)
        print(f"dynamic ROSbot, {name}\n{report.table()}\n", flush=True)
    print(f"rollouts of the dynamic ROSbot under draws: {overhead():.2f} of the time of the nominal plant")


if __name__ == "__main__":
    main()
