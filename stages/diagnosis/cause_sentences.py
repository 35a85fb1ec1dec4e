"""What the rows of causes say of the result: what it is a mean over, and when it holds."""

from inertial.text.messages import _

BY_MEMBERS = _(
    "The parameters are the mean over all that it may be, by how probable each is; the further "
    "terms are those of the most probable."
)
WITH_AND_WITHOUT = _(
    "The parameters are the mean of the result with it and the result without it, by how well each "
    "predicts manoeuvres that its fit has not seen; the further terms are those with it."
)
BY_MEMBERS_AND_WITHOUT = _(
    "The parameters are the mean over the members of the class and over the result without any of "
    "them, by their probability; the further terms are those of the most probable member."
)
OWN_ERROR = _(
    "{manoeuvre} has an unknown error of its own in the model, so that it moves no parameter."
)
ONLY_MODELLED = _("It is in the model of the {sensors} alone.")
IN_COVARIANCE = _("The covariance of the result includes it.")
NO_JUMP = _("The biases of the {sensors} did not change when those of the others did.")
ONE_CHANGE = _(
    "The biases of the {sensors} changed at that place alone, and do not differ from run to run."
)
ALONE = _("What disturbs {manoeuvre}, which is left out, is in this manoeuvre alone.")
OF_GYROS = _("The asymmetry is that of the gyros, and not of the table.")
NO_ATTITUDE = _(
    "What the residuals of the accelerometers show is in their readings, and no error of "
    "attitudes, which the cross-axis terms of the gyros would contain."
)
STAMPS_RIGHT = _("The stamps are right, and the samples are not taken at the stated rate.")
STAMPS_WRONG = _(
    "The turns show which it is: at rates that the table keeps they are off by as much. So the "
    "samples are taken at the stated rate, and the stamps are wrong."
)
WITHOUT_STAMPS = _(
    "Nothing is changed. Correct the clock of the logger; of this recording, leave time out of the "
    "format, so that rate_hz counts the samples."
)
OF_EACH_MANOEUVRE = _(
    "The {sensors} differ from manoeuvre to manoeuvre by more than noise. {effects} would explain "
    "it, but together they have a term for nearly every manoeuvre and would explain anything: the "
    "plan does not show what it is."
)
TURN_AGAIN = _(
    "Repeat the turns in the same positions, some time later: what is the same again goes with the "
    "attitude or the turn, the rest with time."
)
HARMLESS = _("Nothing need be done about it for this result.")
