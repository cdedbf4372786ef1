"""What the data machine executes: expressions in postfix order, and the instructions they become.

Expressions of a whole population stand one after the other in flat arrays: operation, operands (positions in the same
arrays), number. Leaves are positions too: CONSTANT carries its number, VARIABLE - j is column j of the data.
"""

from types import MappingProxyType

from gpsynth.operations import CODES

CONSTANT = -1
VARIABLE = -2  # VARIABLE - j is column j

NAMES = (
    *("add", "sub", "mul", "div", "neg", "abs", "half", "double", "square", "cube", "sqrt", "sin", "cos"),
    *("atan", "exp", "log", "tanh", "max", "min"),
)  # operations of the table that data can be fitted with; all have derivatives
OPCODE = MappingProxyType({name: CODES[name] for name in NAMES})
BINARY = frozenset(("add", "sub", "mul", "div", "max", "min"))

ADD, SUB, MUL, DIV = (CODES[name] for name in ("add", "sub", "mul", "div"))
NEG, ABS, HALF, DOUBLE = (CODES[name] for name in ("neg", "abs", "half", "double"))
SQUARE, CUBE, SQRT = (CODES[name] for name in ("square", "cube", "sqrt"))
SIN, COS, ATAN = (CODES[name] for name in ("sin", "cos", "atan"))
EXP, LOG, TANH = (CODES[name] for name in ("exp", "log", "tanh"))
MAX, MIN = (CODES[name] for name in ("max", "min"))

# Instructions beyond the table: one operand is a number, a row is filled with it, a row is an output,
# or only its sums with the target are.
ADD_NUMBER, SUB_NUMBER, NUMBER_SUB, MUL_NUMBER, DIV_NUMBER, NUMBER_DIV, FILL, EMIT, SCORE = range(100, 109)

# Two of addition, subtraction and product in one, JOINED + 4 first + second: (a first b) second c. The second may also
# be FROM, c - (a first b).
JOINED, FROM = 109, 3
