"""A compressed chunk of a bag, unpacked to the size that the bag states and no byte further."""

from pathlib import Path

import pyarrow as pa

from stages.formats.limits import refuse_piece

AS_IT_IS = ("", "none")
_PACKED = ("lz4", "zstd", "bz2")


def unpacked(path: Path, chunk: bytes, compression: str, size: int) -> bytes:
    """The `size` bytes that the chunk of the bag at `path` holds.

    Raises
    ------
    Refusal
        where `size` is larger than may be unpacked at once
    ValueError
        where the chunk has another size, or is packed in an unknown way
    OSError
        where it is damaged
    """
    refuse_piece(path, "a chunk", size)
    if compression in AS_IT_IS:
        data = chunk
    elif compression in _PACKED:
        with pa.CompressedInputStream(pa.BufferReader(chunk), compression) as stream:
            data = stream.read(size + 1)
    else:
        raise ValueError(f"compression '{compression[:20]}', expected one of {', '.join(_PACKED)}")
    if len(data) != size:
        more = "more" if len(data) > size else f"{len(data)}"
        raise ValueError(f"a chunk of {more} bytes, expected {size}")
    return data
