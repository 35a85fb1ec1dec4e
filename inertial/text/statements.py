"""The sentences of a certificate, on paper and as data alike."""

from inertial.text.messages import _

NOT_STATED = _("not stated")
STATED = _("stated in the campaign file")
GUESSED = _("guessed in the campaign file, and not confirmed")
# Quantities that a plan does not use
NO_POSITION_SET = _("not used, for no position is set")
NO_TURN_SET = _("not used, for no turn is planned")
NO_TABLE = _("not used, for there is no table")
NOT_USED = frozenset({NO_POSITION_SET, NO_TURN_SET, NO_TABLE})
REALISES = {
    "angle": _("angle"),
    "rate": _("rotation rate"),
    "time": _("time"),
    "gravity": _("gravity"),
    "temperature": _("temperature"),
    "humidity": _("humidity"),
}
RULES = {
    "guard_band": _(
        "guarded acceptance (JCGM 106:2012, 8.3): a value conforms if it is within its limit by U, "
        "and does not if it is beyond it by U"
    ),
    "simple_acceptance": _(
        "simple acceptance (JCGM 106:2012, 8.2): a value conforms if it is within its limit; the "
        "risk is shared with the customer, and stated"
    ),
}
STATEMENTS = {
    "conforms": _("conforms"),
    "does_not_conform": _("does not conform"),
    "not_shown": _("neither is shown"),
    "not_assessed": _("not assessed"),
}
TRACEABILITY = _(
    "The values rest on the standards and known quantities stated; where no certificate of a "
    "standard is stated, traceability to the SI is not claimed."
)
THIS_ITEM_ONLY = _(
    "The results relate only to the item calibrated, in the condition and on the day stated."
)
IN_FULL_ONLY = _("The certificate may be reproduced in full only, unless the laboratory agrees.")
