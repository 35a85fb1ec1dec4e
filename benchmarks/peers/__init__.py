"""Programs in the peers' environment that do a peer's part of a benchmark."""
