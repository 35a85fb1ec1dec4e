"""The PDF is made of no table, but of the page of the report."""

from inertial.tables.declared import Declared

DECLARED = Declared(files=("html",), documents=("pdf",))
