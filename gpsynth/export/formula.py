"""A law as plain text to read."""

from gpsynth.export.reading import header_lines, meanings, spell_law
from gpsynth.formula import TEXT
from gpsynth.law import Law


def to_text(law: Law, name: str = "law") -> str:
    """What the law is for, its features and controls as formulas, and what the less common operations mean."""
    formulas = [f"{left} = {right.text}" for left, right in spell_law(law, TEXT)]
    where = [f"  {meaning}" for meaning in meanings(law)]
    return "\n".join([*header_lines(law, name), "", *formulas, *(["", "where", *where] if where else []), ""])
