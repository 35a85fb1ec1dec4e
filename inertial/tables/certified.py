"""The certificate: what the laboratory states beside the numbers, and conformity to tolerances."""

from inertial.tables.table import (
    DOUBLE,
    MOUNT,
    QUANTITY,
    SENSOR,
    TEXT,
    TRUTH,
    Column,
    Table,
    optional,
)

CERTIFICATE = Table(
    "certificate",
    1,
    (
        Column("item", TEXT, "", "key of certificate.schema.yaml, such as customer.name"),
        optional("text", TEXT, "", "what is stated; none: not stated, or a value"),
        optional("value", DOUBLE, "as unit", "of a condition of the room"),
        optional("expanded_uncertainty", DOUBLE, "as unit", "of that value, k = 2"),
        Column("unit", TEXT, "", "of the value"),
        Column("required", TRUTH, "", "ISO/IEC 17025:2017, 7.8, wants it on a certificate"),
        Column("file", TEXT, "", "which states it; empty where none does"),
    ),
)
STANDARDS = Table(
    "standards",
    1,
    (
        Column("realises", TEXT, "", "quantity: angle, rate, time, gravity, temperature, humidity"),
        Column("name", TEXT, "", "what it is"),
        *(
            optional(name, TEXT, "", meaning)
            for name, meaning in (
                ("identification", "serial or inventory number"),
                ("certificate", "number of its certificate"),
                ("issued_by", "who calibrated it"),
                ("valid_until", "until when that holds, YYYY-MM-DD"),
            )
        ),
    ),
)
TOLERANCES = Table(
    "tolerances",
    1,
    (
        SENSOR,
        Column("kind", TEXT, "", "bias, scale or cross"),
        Column("limit", DOUBLE, "as unit", "largest absolute value"),
        Column("unit", TEXT, "", "unit of limit, SI"),
        Column("decision_rule", TEXT, "", "guard_band or simple_acceptance"),
    ),
)
ALLOWED_CHANGES = Table(
    "allowed_changes",
    1,
    (
        SENSOR,
        Column("kind", TEXT, "", "bias, scale or cross"),
        Column(
            "limit",
            DOUBLE,
            "as unit",
            "by how much it may change until the IMU is due, by may_change of the campaign file",
        ),
        Column("unit", TEXT, "", "unit of limit, SI"),
    ),
)
CONFORMITY = Table(
    "conformity",
    2,
    (
        Column("id", TEXT, "", "stable identifier: diagnosis/conformity/sensor/quantity"),
        MOUNT,
        SENSOR,
        QUANTITY,
        Column("limit", DOUBLE, "as unit", "largest absolute value by the tolerance"),
        Column("unit", TEXT, "", "unit of limit, SI"),
        Column("decision_rule", TEXT, "", "guard_band or simple_acceptance"),
        Column(
            "statement",
            TEXT,
            "",
            "conforms, does_not_conform; not_shown: the value is nearer to the limit than U;"
            " not_assessed: there is no value, or the verdict is that it is not usable",
        ),
        Column(
            "risk",
            DOUBLE,
            "1",
            "probability that the statement is wrong; of a normal error",
            "",
            True,
        ),
    ),
)
