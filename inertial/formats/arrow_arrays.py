"""Numbers and texts of a log as Arrow arrays and back, made of their buffers.

`pyarrow.array` and `to_numpy` import pandas wherever it is installed. Decoding needs none of it,
and starts faster and smaller without.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import pyarrow as pa
from numpy.typing import NDArray

from inertial.arrays import Booleans


def numbers_of(values: pa.ChunkedArray) -> NDArray[Any]:
    """The numbers in an Arrow array without nulls, (n,)."""
    return np.from_dlpack(values.combine_chunks())


def array_of_numbers(values: NDArray[Any]) -> pa.Array:
    """An Arrow array of `values`, of their type; null where one is NaN, (n,)."""
    unknown = np.isnan(values) if values.dtype.kind == "f" else np.zeros(0, bool)
    return _array(values, unknown)


def array_of_texts(texts: Sequence[str | None]) -> pa.Array:
    """An Arrow array of `texts`, null where there is none, (n,)."""
    encoded = [(text or "").encode() for text in texts]
    offsets = np.zeros(len(encoded) + 1, np.int32)
    np.cumsum([len(text) for text in encoded], out=offsets[1:])
    validity = _validity(np.array([text is None for text in texts], bool))
    buffers = [validity, pa.py_buffer(offsets), pa.py_buffer(b"".join(encoded))]
    return pa.Array.from_buffers(pa.string(), len(encoded), buffers)


def repeated_text(text: str, times: int) -> pa.Array:
    """`text` as often as told, as a dictionary of one word, (times,)."""
    return pa.DictionaryArray.from_arrays(
        array_of_numbers(np.zeros(times, np.int32)), array_of_texts([text])
    )


def batch_of_rows(rows: Sequence[Mapping[str, Any]], schema: pa.Schema) -> pa.RecordBatch:
    """A few rows as a record batch; None becomes null. The schema has texts and numbers only."""
    arrays = []
    for field in schema:
        values = [row[field.name] for row in rows]
        if field.type == pa.string():
            arrays.append(array_of_texts(values))
        else:
            unknown = np.array([value is None for value in values], bool)
            filled = [0 if value is None else value for value in values]
            arrays.append(_array(np.array(filled, field.type.to_pandas_dtype()), unknown))
    return pa.RecordBatch.from_arrays(arrays, schema=schema)


def _array(values: NDArray[Any], unknown: Booleans) -> pa.Array:
    buffers = [_validity(unknown), pa.py_buffer(np.ascontiguousarray(values))]
    return pa.Array.from_buffers(pa.from_numpy_dtype(values.dtype), len(values), buffers)


def _validity(unknown: Booleans) -> pa.Buffer | None:
    """Arrow's bitmap of what is not null; None where nothing is."""
    return pa.py_buffer(np.packbits(~unknown, bitorder="little")) if unknown.any() else None
