"""The gain of a candidate in words."""

from collections.abc import Mapping

from inertial.text.cause_names import in_words
from inertial.text.enumeration import listed
from inertial.text.messages import _
from stages.extension.candidates import Candidate
from stages.extension.cross_validation import CrossValidation

WITHOUT = _("Joint fit of all manoeuvres, without effects.")
REDUCED = _(
    "With {effects} χ² of manoeuvres that the fit has not seen is reduced by {drop:.1f}, of "
    "{expected:.1f} that exactly known effects would bring."
)
INCREASED = _(
    "With {effects} χ² of manoeuvres that the fit has not seen grows by {growth:.1f}, where "
    "exactly known effects would reduce it by {expected:.1f}."
)
AGAINST_WALK = _(
    " Against the joint fit, which describes some of it by a random walk of the biases, it is "
    "reduced by {drop:.1f}."
)
NOT_COUNTED = _(
    " Not counted: {manoeuvres}; without {each} the others show less than half of the effect."
)
CARRIED = _(" Without {manoeuvre} the others do not show {effect}.")


def sentence_of(
    candidate: Candidate,
    validated: CrossValidation | None,
    carriers: Mapping[str, str | None],
) -> str:
    """What the model gains on held-out data, and which manoeuvres alone show its effects."""
    if validated is None:
        return WITHOUT
    effects = listed([in_words(e.name) for e in candidate.effects])
    expected = validated.expected_drop
    if validated.drop >= 0:
        sentence = REDUCED.format(effects=effects, drop=validated.drop, expected=expected)
    else:
        sentence = INCREASED.format(effects=effects, growth=-validated.drop, expected=expected)
    if validated.walk_drop > 0:
        sentence += AGAINST_WALK.format(drop=validated.drop - validated.walk_drop)
    if omitted := validated.not_counted:
        each = "it" if len(omitted) == 1 else "each"
        sentence += NOT_COUNTED.format(manoeuvres=", ".join(omitted), each=each)
    for effect, manoeuvre in carriers.items():
        if manoeuvre:
            sentence += CARRIED.format(manoeuvre=manoeuvre, effect=in_words(effect))
    return sentence
