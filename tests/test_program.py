"""Programs: folding, hashing, JSON, and what is refused."""

import copy
import hashlib
import json
import pickle

import numpy as np
import pytest

from gpsynth.builder import Builder
from gpsynth.errors import ProgramError
from gpsynth.kernels import elementary
from gpsynth.program import MOST_INSTRUCTIONS, Program
from gpsynth.seeds import stream


def example():
    """A = x q + 1/2, b = y."""
    builder = Builder(("x", "y"), ("q",))
    (x, y), (q,) = builder.inputs, builder.parameters
    return builder.build(
        [builder.apply("add", builder.apply("mul", x, q), builder.constant(0.5)), y], ("a", "b")
    )


def test_call_computes_every_row():
    inputs = np.array([[1.0, 2.0], [3.0, 4.0], [np.nan, -0.0]])
    assert np.array_equal(example()(inputs, [2.0]), [[2.5, 2.0], [6.5, 4.0], [np.nan, -0.0]], equal_nan=True)


def test_call_takes_one_parameter_vector_a_row():
    inputs = np.array([[1.0, 2.0], [3.0, 4.0]])
    assert np.array_equal(example()(inputs, [[2.0], [10.0]]), [[2.5, 2.0], [30.5, 4.0]])


def test_call_takes_arrays_of_any_layout():
    inputs, parameters = stream(1).normal(size=(2, 200, 4))
    whole = example()(np.ascontiguousarray(inputs[::2, ::3]), np.ascontiguousarray(parameters[::2, :1]))
    assert np.array_equal(example()(inputs[::2, ::3], parameters[::2, :1]), whole)
    assert np.array_equal(example()(np.asfortranarray(inputs[::2, ::3]), parameters[::2, :1]), whole)


def test_call_of_no_rows_gives_no_rows():
    assert example()(np.empty((0, 2)), [1.0]).shape == (0, 2)


@pytest.mark.parametrize(
    "inputs", [np.zeros(2), np.zeros((3, 1)), np.zeros((1, 1, 2)), 1.0, "ab", [["x", "y"]], None]
)
def test_call_refuses_inputs_of_another_shape(inputs):
    with pytest.raises(ProgramError, match="inputs"):
        example()(inputs, [1.0])


@pytest.mark.parametrize(
    "parameters", [(), [1, 2], [[1], [2]], np.zeros((1, 1, 1)), 1.0, None, ["q"], [[1], [2, 3]]]
)
def test_call_refuses_parameters_of_another_shape(parameters):
    with pytest.raises(ProgramError, match="parameters"):
        example()(np.zeros((3, 2)), parameters)


def test_fold_visits_leaves_and_instructions_once_in_order():
    visited = []
    program = example()
    program.fold(
        lambda leaf: visited.append((leaf.kind, leaf.name, leaf.value)),
        lambda operation, operands: visited.append(operation.name),
    )
    leaves = [("input", "x", 0.0), ("input", "y", 0.0), ("parameter", "q", 0.0), ("constant", "", 0.5)]
    assert visited == [*leaves, "mul", "add"]


def test_fold_gives_the_value_of_each_output():
    values = {"x": 3.0, "y": 4.0, "q": 2.0}
    outputs = example().fold(
        lambda leaf: values.get(leaf.name, leaf.value),
        lambda operation, operands: elementary.evaluate(operation.name, *operands),
    )
    assert outputs == (6.5, 4.0)


def test_depth_is_the_longest_chain():
    assert example().depth == 2
    assert Builder(("x",)).build([0]).depth == 0
    assert Builder(("x",)).build([]).depth == 0


def test_depth_of_a_program_that_shares_values_is_computed_at_once():
    builder = Builder(("x",))
    value = builder.inputs[0]
    for _ in range(2000):  # 2^2000 paths
        value = builder.apply("add", value, value)
    assert builder.build([value]).depth == 2000


def test_complexity_counts_shared_values_once():
    builder = Builder(("x",))
    sine = builder.apply("sin", builder.inputs[0])
    assert builder.build([builder.apply("mul", sine, sine)]).complexity == 2


def test_hash_is_the_same_on_every_machine():
    assert example().hash == "c690d5cbad0d8f0782a7a69e01713251bf1ce3837bf9c0fc847c3f3830b843a4"


@pytest.mark.parametrize(
    "change",
    [
        {"inputs": ("x", "z")},
        {"parameters": ("p",)},
        {"constants": np.array([0.25])},
        {"names": ("a", "c")},
        {"outputs": np.array([5, 0])},
        {"code": np.array([[2, 0, 2, -1], [1, 4, 3, -1]])},
        {"code": np.array([[2, 1, 2, -1], [0, 4, 3, -1]])},
    ],
)
def test_hash_and_equality_go_by_content(change):
    fields = ("inputs", "parameters", "constants", "code", "outputs", "names")
    values = {field: getattr(example(), field) for field in fields}
    assert Program(**values) == example()
    assert hash(Program(**values)) == hash(example())
    assert Program(**{**values, **change}) != example()


def test_negative_zero_is_another_constant():
    zero, minus_zero = ([Builder(()).constant(value)] for value in (0.0, -0.0))
    assert zero == minus_zero  # both are the first value of their builders
    programs = []
    for value in (0.0, -0.0):
        builder = Builder(())
        programs.append(builder.build([builder.constant(value)]))
    assert programs[0] != programs[1]
    assert np.signbit(programs[1](np.empty((1, 0))))


@pytest.mark.parametrize("copied", [lambda p: pickle.loads(pickle.dumps(p)), copy.deepcopy, copy.copy])
def test_copies_are_equal_and_frozen(copied):
    program = copied(example())
    assert program == example()
    for array in (program.constants, program.code, program.outputs):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_the_callers_arrays_are_neither_kept_nor_frozen():
    constants = np.array([0.5])
    program = Program((), (), constants, np.empty((0, 4), dtype=np.int32), np.array([0]), ("a",))
    constants[0] = 7.0
    assert program.constants[0] == 0.5


def test_json_round_trip_keeps_everything():
    builder = Builder(("x",))
    values = [builder.constant(value) for value in (0.1, -0.0, 5e-324, np.inf, np.nan, 1e308)]
    program = builder.build(
        [builder.apply("where", builder.inputs[0], *values[:2]), *values], tuple("abcdefg")
    )
    assert Program.from_dict(json.loads(json.dumps(program.to_dict()))) == program


HOSTILE = {
    "inputs_missing": {"inputs": ["x"]},
    "inputs_text": {"inputs": "xy"},
    "inputs_dictionary": {"inputs": {"x": 0, "y": 1}},
    "inputs_null": {"inputs": None},
    "input_number": {"inputs": ["x", 5]},
    "input_list": {"inputs": ["x", ["y"]]},
    "input_no_name": {"inputs": ["x", "y; system()"]},
    "input_line_break": {"inputs": ["x", "y\n"]},
    "input_twice": {"inputs": ["x", "x"]},
    "input_and_parameter": {"parameters": ["x"]},
    "constant_number": {"constants": [0.5]},
    "constant_true": {"constants": [True]},
    "constant_decimal": {"constants": ["1e400"]},
    "constant_enormous": {"constants": ["0x1p+5000"]},
    "constant_word": {"constants": ["half"]},
    "constant_text": {"constants": "0"},
    "constants_too_few": {"constants": []},
    "code_null": {"code": None},
    "code_dictionary": {"code": {"mul": [0, 2]}},
    "code_word": {"code": ["mul", "add"]},
    "instruction_empty": {"code": [[], []]},
    "instruction_dictionary": {"code": [{"mul": 0}]},
    "operation_unknown": {"code": [["mul", 0, 2], ["exec", 4, 3]]},
    "operation_list": {"code": [[["mul"], 0, 2]]},
    "operation_number": {"code": [[2, 0, 2], [0, 4, 3]]},
    "operands_too_few": {"code": [["mul", 0], ["add", 4, 3]]},
    "operands_too_many": {"code": [["mul", 0, 2, 2], ["add", 4, 3]]},
    "operand_forward": {"code": [["mul", 0, 5], ["add", 4, 3]]},
    "operand_itself": {"code": [["mul", 0, 4], ["add", 4, 3]]},
    "operand_negative": {"code": [["mul", 0, -1], ["add", 4, 3]]},
    "operand_true": {"code": [["mul", 0, True], ["add", 4, 3]]},
    "operand_float": {"code": [["mul", 0, 2.0], ["add", 4, 3]]},
    "operand_text": {"code": [["mul", 0, "2"], ["add", 4, 3]]},
    "operand_enormous": {"code": [["mul", 0, 10**30], ["add", 4, 3]]},
    "operand_wrapping": {"code": [["mul", 0, 2**32 + 2], ["add", 4, 3]]},
    "code_too_long": {"code": [["mul", 0, 2]] * (MOST_INSTRUCTIONS + 1)},
    "output_beyond": {"outputs": [6, 1]},
    "output_negative": {"outputs": [-1, 1]},
    "output_true": {"outputs": [5, True]},
    "output_float": {"outputs": [5.0, 1]},
    "output_list": {"outputs": [[5], [1]]},
    "outputs_number": {"outputs": 5},
    "names_too_few": {"names": ["a"]},
    "names_text": {"names": "ab"},
    "names_equal": {"names": ["a", "a"]},
    "name_no_text": {"names": ["a", None]},
    "hash_wrong": {"hash": "0" * 64},
    "hash_null": {"hash": None},
    "format_other": {"format": "gpsynth-program/2"},
    "field_unknown": {"comment": "hello"},
}


@pytest.mark.parametrize("change", HOSTILE.values(), ids=HOSTILE)
def test_hostile_document_is_refused(change):
    content = {key: value for key, value in example().to_dict().items() if key != "hash"} | change
    fresh = hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()  # anybody can hash
    with pytest.raises(ProgramError):
        Program.from_dict({"hash": fresh, **content})


@pytest.mark.parametrize(
    "change", [{"constants": [(0.25).hex()]}, {"names": ["a", "c"]}, {"outputs": [4, 1]}]
)
def test_changed_content_is_refused(change):
    with pytest.raises(ProgramError, match="does not match its hash"):
        Program.from_dict({**example().to_dict(), **change})


@pytest.mark.parametrize("field", example().to_dict())
def test_document_without_a_field_is_refused(field):
    document = example().to_dict()
    del document[field]
    with pytest.raises(ProgramError):
        Program.from_dict(document)


@pytest.mark.parametrize("document", [None, [], "program", 5, {}, {"format": []}, {1: 2}])
def test_what_is_no_document_is_refused(document):
    with pytest.raises(ProgramError, match="format"):
        Program.from_dict(document)


def test_constants_are_read_as_hexadecimal():
    assert Program.from_dict({**example().to_dict(), "constants": ["0x0.8p0"]}) == example()


WRONG = {
    "inputs_text": {"inputs": "x"},
    "outputs_deep": {"outputs": np.array([[2]])},
    "outputs_floats": {"outputs": np.array([2.7])},
    "code_floats": {"code": np.array([[0.5, 0.0, 1.0, -1.0]])},
    "code_narrow": {"code": np.array([[0, 0, 1]])},
    "code_wrapping": {"code": np.array([[0, 0, 2**32 + 1, -1]])},
    "code_unknown_operation": {"code": np.array([[10**6, 0, 1, -1]])},
    "code_negative_operation": {"code": np.array([[-1, 0, 1, -1]])},
    "operand_itself": {"code": np.array([[0, 0, 2, -1]])},
    "output_beyond": {"outputs": np.array([3])},
    "unused_operand_used": {"code": np.array([[0, 0, 1, 0]])},
    "constants_deep": {"constants": np.array([[1.0]])},
    "constants_texts": {"constants": np.array(["a"])},
    "constants_complex": {"constants": np.array([1j])},
}


@pytest.mark.parametrize("change", WRONG.values(), ids=WRONG)
def test_constructor_refuses_what_is_not_well_formed(change):
    fields = {"inputs": ("x",), "parameters": (), "constants": np.array([1.0]), "names": ("y",)}
    code = {"code": np.array([[0, 0, 1, -1]]), "outputs": np.array([2])}
    Program(**fields, **code)
    with pytest.raises(ProgramError):
        Program(**{**fields, **code, **change})
