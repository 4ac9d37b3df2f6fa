"""Results of decoding, README.md section 6."""


class Refused(Exception):
    """A stream, or a part of it, that is not decoded. `name` is the result's name in the specification."""
    name = "refused"


class Corrupt(Refused):
    name = "corrupt"


class Truncated(Refused):
    name = "truncated"


class Unsupported(Refused):
    name = "unsupported"


class LimitExceeded(Refused):
    name = "limit exceeded"


def require(condition, sentence):
    if not condition:
        raise Corrupt(sentence)
