"""Of which mount a row of a table is, where there are several."""


def mount_of(identifier: str) -> str:
    """The mount in an identifier, such as upright of criticism/lever_arm@upright/r_x; or empty."""
    return next((part.partition("@")[2] for part in identifier.split("/") if "@" in part), "")
