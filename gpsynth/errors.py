"""What a user can get wrong, as one sentence each; the command line turns these into exit code 2."""


class GpsynthError(Exception):
    """Base of every error a user can cause; its text says what was expected, what came, and where."""


class OperationError(GpsynthError):
    """An operation that is not in the table, or is used with the wrong number of operands."""


class ProgramError(GpsynthError):
    """A program that is not well formed, or is asked for something it does not have."""


class TracingError(GpsynthError):
    """A Python function that cannot become a program; the text names the line."""


class FormulaError(GpsynthError):
    """A formula given as text, function or program that cannot be used as one."""


class UnitError(GpsynthError):
    """A unit that cannot be read, or units that do not fit together."""


class PlantError(GpsynthError):
    """A plant whose states, controls, limits or derivatives do not fit together."""


class ProblemError(GpsynthError):
    """A problem whose starts, goal, tolerance or times do not fit its plant."""


class LawError(GpsynthError):
    """A law that does not fit its plant, or is called with the wrong shapes."""


class EncodingError(GpsynthError):
    """A genome, matrix or setting that an encoding cannot read."""


class OptimizerError(GpsynthError):
    """Settings of an optimizer that contradict each other."""


class RegressionError(GpsynthError):
    """Data or settings of a symbolic regression that do not fit together."""


class ScenarioError(GpsynthError):
    """A planning scenario that is malformed or contradicts itself."""


class FileError(GpsynthError):
    """A file that is missing, unreadable, too large or not of the expected format."""


class MissingPackageError(GpsynthError):
    """A package that a feature needs and that is not installed; the text says how to install it."""
