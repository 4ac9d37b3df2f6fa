"""Reference decoder of the Reeb format, one module a chapter of the specification. See ../reference_decoder.py."""
