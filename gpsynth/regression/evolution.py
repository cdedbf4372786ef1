"""Genetic programming on trees: what enumeration does not reach is grown, and its numbers are fitted as it grows.

Errors are those of the best slope and constant (Keijzer 2003); the best of each generation get a few steps of
Levenberg-Marquardt and keep the numbers (Lamarck). Of children with the same error only the shortest lives.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from gpsynth.arrays import Floats, Ints
from gpsynth.kernels import fitting, genomes
from gpsynth.kernels.data_code import BINARY, CONSTANT, FILL, OPCODE
from gpsynth.kernels.layout import readonly
from gpsynth.regression.expressions import Expression, expression_of
from gpsynth.regression.library import LARGEST
from gpsynth.regression.population import Population, columns_of, evaluate, scores, scoring, share
from gpsynth.regression.selection import columns_of as columns_from
from gpsynth.regression.selection import select
from gpsynth.regression.state import TERMS, WIDTH, State
from gpsynth.regression.targets import Target, derived, plain

SIZE = 600
CHILDREN = 600
LONGEST = 40  # nodes
YOUNG = 15  # nodes of a random tree
FITTED = 30  # children whose numbers are fitted in each generation
STEPS = 4
TOURNAMENT = 4
PARSIMONY = 0.01  # a node must lower the error by this share
PATIENCE = 30  # generations without progress before a new beginning
REPORT = 5  # generations between two looks at the best
HARVEST = 15  # generations between two selections among subtrees
HARVESTED = 60  # trees whose subtrees are columns


class Trees(NamedTuple):
    """Trees in postfix order, one row each."""

    ops: Ints  # (p, LONGEST)
    numbers: Floats  # (p, LONGEST)
    lengths: Ints  # (p,)

    def take(self, which: npt.NDArray[np.integer]) -> "Trees":
        """The trees with these indices."""
        return Trees(self.ops[which], self.numbers[which], self.lengths[which])


class Grammar(NamedTuple):
    """What trees are made of."""

    unary: Ints
    binary: Ints
    variables: int


class Scored(NamedTuple):
    """Trees, errors as a share of y's deviation, slopes and constants."""

    trees: Trees
    error: Floats
    slope: Floats
    constant: Floats


def evolve(state: State) -> Iterator[None]:
    """Generation after generation, without end; the best go into the state's front."""
    evolution = Evolution(state)
    y = plain(state.y)
    targets = [y, *derived(y, np.empty((len(state.y), 0)), state.functions)]
    while True:
        population = evolution.scored(evolution.random(SIZE))
        best, waited = np.inf, 0
        generation = 0
        while waited < PATIENCE and not state.done:
            population = evolution.next_generation(population)
            generation += 1
            least = float(population.error.min())
            waited = 0 if least < 0.99 * best else waited + 1
            best = min(best, least)
            if generation % REPORT == 0:
                evolution.report(population)
            if generation % HARVEST == 0:
                evolution.harvest(population, targets)
            yield
        evolution.report(population)
        yield


class Evolution:
    """The data and the grammar of one search."""

    def __init__(self, state: State) -> None:
        self.state, self.rng = state, state.rng
        names = sorted(state.functions | ({"square"} if "mul" in state.functions else set()))
        unary, binary = (
            readonly(np.array([OPCODE[name] for name in names if (name in BINARY) == two], dtype=np.int32))
            for two in (False, True)
        )
        self.grammar = Grammar(unary, binary, state.data.inputs.shape[1])
        rows = state.rows
        self.inputs = state.data.inputs[rows]
        self.columns = readonly(columns_of(self.inputs))
        weights = state.data.weights[rows].copy()
        self.scoring = scoring(self.inputs, state.y[rows], weights)
        padding = self.columns.shape[1] - len(rows)
        self.padded_y = readonly(np.pad(state.y[rows], (0, padding)))
        self.padded_weights = readonly(np.pad(weights, (0, padding)))

    def random(self, count: int) -> Trees:
        """Random trees of 1 to 15 nodes."""
        longest = YOUNG if len(self.grammar.binary) else YOUNG // 2
        lengths = self.rng.integers(1, longest + 1, count).astype(np.int32)
        if len(self.grammar.unary) == 0:
            lengths |= 1  # only odd lengths are trees then
        ops, numbers = np.zeros((count, LONGEST), dtype=np.int32), np.zeros((count, LONGEST))
        uniforms = self.rng.random((count, genomes.DRAWS * LONGEST))
        genomes.grow(*self.grammar, readonly(lengths), readonly(uniforms), ops, numbers)
        return Trees(ops, numbers, lengths)

    def scored(self, trees: Trees) -> Scored:
        """Errors of all trees; equal subtrees are evaluated once."""
        self.state.evaluations += len(trees.lengths)
        return Scored(trees, *scores(flat_of(trees), self.scoring))

    def children(self, parents: Scored) -> Trees:
        """CHILDREN trees: parents by tournament, a subtree exchanged or replaced by a random one, a node changed."""
        count = len(parents.error)
        keys = parents.error * (1.0 + PARSIMONY * parents.trees.lengths)
        entrants = self.rng.integers(0, count, (2, CHILDREN, TOURNAMENT))
        mates = np.take_along_axis(entrants, keys[entrants].argmin(axis=2)[..., None], axis=2)[..., 0].T
        fresh = self.random(CHILDREN // 10)
        donors = _joined(parents.trees, fresh)
        mates[: 2 * len(fresh.lengths) : 2, 1] = count + np.arange(len(fresh.lengths))
        made = Trees(
            np.zeros((CHILDREN, LONGEST), np.int32),
            np.zeros((CHILDREN, LONGEST)),
            np.zeros(CHILDREN, np.int32),
        )
        genomes.vary(
            *self.grammar,
            *(parents.trees.ops, parents.trees.numbers, readonly(parents.trees.lengths)),
            *(donors.ops, donors.numbers, readonly(donors.lengths)),
            readonly(np.ascontiguousarray(mates, dtype=np.int32)),
            readonly(self.rng.random((CHILDREN, genomes.CHOICES))),
            *made,
        )
        return made

    def next_generation(self, parents: Scored) -> Scored:
        """Children, the best of them fitted, and whoever is better lives."""
        offspring = self.fitted(self.scored(self.children(parents)))
        values = (np.concatenate(pair) for pair in zip(parents[1:], offspring[1:], strict=True))
        return self.survivors(Scored(_joined(parents.trees, offspring.trees), *values))

    def fitted(self, scored: Scored) -> Scored:
        """The best children with better numbers."""
        has_numbers = np.any(
            (scored.trees.ops == CONSTANT) & (np.arange(LONGEST) < scored.trees.lengths[:, None]), axis=1
        )
        order = np.argsort(np.where(has_numbers, scored.error, np.inf), kind="stable")
        _, first = np.unique(scored.error[order], return_index=True)
        chosen = order[np.sort(first)][:FITTED]
        chosen = chosen[has_numbers[chosen] & np.isfinite(scored.error[chosen])].astype(np.int32)
        if len(chosen) == 0:
            return scored
        trees = scored.trees.take(chosen)
        some = _scaled_flat(trees, scored.slope[chosen], scored.constant[chosen])
        constants = np.flatnonzero(some.ops == CONSTANT).astype(np.int32)
        firsts = np.concatenate(([0], some.roots[:-1] + 1)).astype(np.int32)
        ends = np.searchsorted(constants, some.roots, side="right").astype(np.int32)
        code = np.stack(
            (np.where(some.ops == CONSTANT, FILL, some.ops), np.arange(len(some.ops)), some.a, some.b), axis=1
        ).astype(np.int32)
        values = some.numbers.copy()
        spans = readonly(firsts), readonly(some.roots + np.int32(1))
        rows = self.columns, self.padded_y, self.padded_weights
        errors = fitting.fit(readonly(code), values, spans, readonly(constants), readonly(ends), rows, STEPS)
        self.state.evaluations += STEPS * len(chosen)
        for k, tree in enumerate(chosen.tolist()):
            length = int(trees.lengths[k])
            scored.trees.numbers[tree, :length] = values[firsts[k] : firsts[k] + length]
            scored.error[tree] = errors[k] / (self.scoring.total or 1.0)
            scored.constant[tree], scored.slope[tree] = (
                values[firsts[k] + length],
                values[firsts[k] + length + 1],
            )
        return scored

    def survivors(self, scored: Scored) -> Scored:
        """The best SIZE of different error; where errors agree, the shortest."""
        error = np.where(np.isnan(scored.error), np.inf, scored.error)
        fraction, exponent = np.frexp(error)
        rounded = np.ldexp(np.round(fraction * 2.0**20), exponent)
        order = np.lexsort((scored.trees.lengths, rounded))
        first = np.concatenate(([True], rounded[order][1:] != rounded[order][:-1]))
        unique = order[first]
        keys = error[unique] * (1.0 + PARSIMONY * scored.trees.lengths[unique])
        kept = unique[np.argsort(keys, kind="stable")[:SIZE]]
        return Scored(scored.trees.take(kept), error[kept], scored.slope[kept], scored.constant[kept])

    def report(self, population: Scored, count: int = 6) -> None:
        """The best trees, as formulas of y, into the front."""
        keys = population.error
        best = np.argsort(keys, kind="stable")[:count]
        short = np.argsort(np.where(population.trees.lengths <= 12, keys, np.inf), kind="stable")[:2]
        chosen = np.unique(np.concatenate((best, short))).astype(np.int32)
        chosen = chosen[np.isfinite(population.error[chosen])]
        if len(chosen) == 0:
            return
        flat = _scaled_flat(
            population.trees.take(chosen), population.slope[chosen], population.constant[chosen]
        )
        found: list[Expression] = [expression_of(flat, int(root)) for root in flat.roots]
        self.state.consider(found, "evolution", iterations=20)

    def harvest(self, population: Scored, targets: list[Target]) -> None:
        """Sums of subtrees of the best trees, by forward selection: what evolved in different trees comes together."""
        best = np.argsort(population.error, kind="stable")[:HARVESTED].astype(np.int32)
        flat = flat_of(population.trees.take(best))
        shared = share(flat._replace(roots=np.arange(len(flat.ops), dtype=np.int32)))
        values = evaluate(shared, self.columns)[:, : len(self.inputs)]
        _, position = np.unique(shared.outputs, return_index=True)
        with np.errstate(all="ignore"):
            usable = np.flatnonzero(np.abs(values).max(axis=1) < LARGEST)
        columns = columns_from(values[usable])
        self.state.evaluations += len(usable) * len(targets)

        def expression(column: int) -> Expression:
            return expression_of(flat, int(position[usable[columns.formula[column]]]))

        for target in targets:
            subsets = select(columns, target.values[self.state.rows], terms=TERMS, width=WIDTH)
            self.state.consider_sums(subsets, expression, target, "sums of evolved subtrees")


def _joined(first: Trees, second: Trees) -> Trees:
    return Trees(
        np.concatenate((first.ops, second.ops)),
        np.concatenate((first.numbers, second.numbers)),
        np.concatenate((first.lengths, second.lengths)),
    )


def flat_of(trees: Trees) -> Population:
    """The trees one after the other."""
    size = int(trees.lengths.sum())
    ops, a, b = np.empty((3, size), dtype=np.int32)
    numbers, roots = np.empty(size), np.empty(len(trees.lengths), dtype=np.int32)
    stack = np.empty(LONGEST + 4, dtype=np.int32)
    genomes.flatten(trees.ops, trees.numbers, readonly(trees.lengths), ops, a, b, numbers, roots, stack)
    return Population(ops, a, b, numbers, roots)


def _scaled_flat(trees: Trees, slope: Floats, constant: Floats) -> Population:
    """slope * tree + constant for each tree; the two numbers come right behind it, constant first."""
    count = len(trees.lengths)
    ops = np.pad(trees.ops, ((0, 0), (0, 4)))
    numbers = np.pad(trees.numbers, ((0, 0), (0, 4)))
    rows = np.arange(count)
    tail = (CONSTANT, CONSTANT, OPCODE["mul"], OPCODE["add"])
    for k, op in enumerate(tail):
        ops[rows, trees.lengths + k] = op
    numbers[rows, trees.lengths], numbers[rows, trees.lengths + 1] = constant, slope
    scaled = Trees(ops, numbers, trees.lengths + np.int32(4))
    flat = flat_of(scaled)
    # postfix order: tree, constant, slope, mul, add; so mul takes slope and tree, add takes the constant
    multiplied, added = flat.roots - 1, flat.roots
    flat.a[multiplied], flat.b[multiplied] = flat.roots - 2, flat.roots - 4
    flat.a[added], flat.b[added] = multiplied, flat.roots - 3
    return flat
