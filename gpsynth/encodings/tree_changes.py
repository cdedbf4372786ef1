"""What a mutation does to one of DEAP's trees: DEAP's own changes and one of ours.

All draw from Python's generator, which the caller has seeded.
"""

import random
from collections.abc import Callable
from functools import partial
from math import exp

from deap import gp

Number = Callable[[float], gp.Terminal]  # the leaf that holds a value


def changed(
    tree: gp.PrimitiveTree, grammar: gp.PrimitiveSet, heights: tuple[int, int], number: Number | None
) -> gp.PrimitiveTree:
    """The tree with one change; a whole new subtree (of these heights) is the commonest, the others are small steps.

    Without `number` no extension is tried; with it, the grammar has add and mul.
    """
    draw = random.random()  # noqa: S311 the generator is ours while it is lent
    if draw < 0.3 and number is not None:
        return _extended(tree, grammar, heights, number)
    if draw < 0.4:
        return gp.mutInsert(tree, grammar)[0]
    if draw < 0.5:
        return gp.mutShrink(tree)[0]
    if draw < 0.65:
        return gp.mutNodeReplacement(tree, grammar)[0]
    grow = partial(gp.genHalfAndHalf, min_=heights[0], max_=heights[1])
    return gp.mutUniform(tree, expr=grow, pset=grammar)[0]


def _extended(
    tree: gp.PrimitiveTree, grammar: gp.PrimitiveSet, heights: tuple[int, int], number: Number
) -> gp.PrimitiveTree:
    """A node plus a weighted term, times a number near 1 or plus a number near 0.

    What the tree did it still does, nearly; tuning the new number shows what the extension is worth.
    """
    place = tree.searchSubtree(random.randrange(len(tree)))  # noqa: S311 as above
    add, times = grammar.mapping["add"], grammar.mapping["mul"]
    draw = random.random()  # noqa: S311
    if draw < 0.5:
        weight = random.choice((-1.0, 1.0)) * exp(random.uniform(-3.0, 1.5))  # noqa: S311
        tree[place] = [add, *tree[place], times, number(weight), *_term(grammar, heights)]
    elif draw < 0.85:
        tree[place] = [times, *tree[place], number(random.gauss(1.0, 0.1))]
    else:
        tree[place] = [add, *tree[place], number(random.gauss(0.0, 0.1))]
    return tree


def _term(grammar: gp.PrimitiveSet, heights: tuple[int, int]) -> list[gp.Primitive | gp.Terminal]:
    if random.random() < 0.5:  # noqa: S311
        return [grammar.mapping[random.choice(grammar.arguments)]]  # noqa: S311
    return list(gp.genHalfAndHalf(grammar, *heights))
