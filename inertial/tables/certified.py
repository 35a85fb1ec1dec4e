"""The certificate: what the laboratory states beside the numbers, and conformity to tolerances."""

from inertial.tables.table import (
    MOUNT,
    QUANTITY,
    SENSOR,
    number,
    optional_number,
    optional_text,
    table,
    text,
    truth,
)

CERTIFICATE = table(
    "certificate",
    1,
    text("item", "key of certificate.schema.yaml, such as customer.name"),
    optional_text("text", "what is stated; none: not stated, or a value"),
    optional_number("value", "as unit", "of a condition of the room"),
    optional_number("expanded_uncertainty", "as unit", "of that value, k = 2"),
    text("unit", "of the value"),
    truth("required", "ISO/IEC 17025:2017, 7.8, wants it on a certificate"),
    text("file", "which states it; empty where none does"),
)
STANDARDS = table(
    "standards",
    1,
    text("realises", "quantity: angle, rate, time, gravity, temperature, humidity"),
    text("name", "what it is"),
    *(
        optional_text(name, meaning)
        for name, meaning in (
            ("identification", "serial or inventory number"),
            ("certificate", "number of its certificate"),
            ("issued_by", "who calibrated it"),
            ("valid_until", "until when that holds, YYYY-MM-DD"),
        )
    ),
)
TOLERANCES = table(
    "tolerances",
    1,
    SENSOR,
    text("kind", "bias, scale or cross"),
    number("limit", "as unit", "largest absolute value"),
    text("unit", "unit of limit, SI"),
    text("decision_rule", "guard_band or simple_acceptance"),
)
ALLOWED_CHANGES = table(
    "allowed_changes",
    1,
    SENSOR,
    text("kind", "bias, scale or cross"),
    number(
        "limit",
        "as unit",
        "by how much it may change until the IMU is due, by may_change of the campaign file",
    ),
    text("unit", "unit of limit, SI"),
)
CONFORMITY = table(
    "conformity",
    2,
    text("id", "stable identifier: diagnosis/conformity/sensor/quantity"),
    MOUNT,
    SENSOR,
    QUANTITY,
    number("limit", "as unit", "largest absolute value by the tolerance"),
    text("unit", "unit of limit, SI"),
    text("decision_rule", "guard_band or simple_acceptance"),
    text(
        "statement",
        "conforms, does_not_conform; not_shown: the value is nearer to the limit than U;"
        " not_assessed: there is no value, or the verdict is that it is not usable",
    ),
    optional_number("risk", "1", "probability that the statement is wrong; of a normal error"),
)
