"""The PDF is made of no table, but of the page of the report and the files attached to it."""

from inertial.tables.declared import Declared

DECLARED = Declared(files=("html", "attached"), documents=("pdf",))
