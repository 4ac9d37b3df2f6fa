"""What is measured: Reeb in its settings, Reeb without one coding tool, and other codecs."""
import dataclasses

KG_TARGETS = ("1", "0.5", "0.2", "0.1", "0.05", "0.02")
ABLATION_TARGETS = ("0.5", "0.1", "0.02")

# Coding tools that a build can leave out (codec/common/base/coding_tools.h), with words for people.
TOOLS = {
    "extra-neighbours": "extra neighbours (ring only)",
    "re-estimation": "re-estimation of the weights",
    "mass-steps": "mass-weighted steps and decisions",
    "rdo": "rate-distortion optimised quantization",
    "mixing": "context mixing (one table)",
    "basis-hierarchy": "hierarchy in time (basis in order)",
    "basis-learning": "learned weights of the basis",
    "basis-refit": "refit of the basis",
    "grid-trial": "trial of the grid",
    "order-guesses": "guesses of the vertex order",
}


@dataclasses.dataclass(frozen=True)
class Configuration:
    name: str
    group: str  # profile, effort, ablation, bounded, lossless or peer
    words: str  # for people
    targets: tuple
    unit: str = "kg"  # of the targets
    options: tuple = ()  # of `reeb encode`
    peer: str = ""  # the driver in peers/, where it is not Reeb
    without: str = ""  # the coding tool that a build for it leaves out

    @property
    def keeps_order(self):
        return "--reorder" not in self.options

    def target_of(self, setting):
        """How the table names a setting."""
        return self.unit if self.unit == "lossless" else f"{self.unit}={setting}"

    def encode_command(self, programs, setting, inputs, stream):
        """`programs` names the executables: reeb, or the driver."""
        if self.peer:
            return [programs[self.peer + "_peer"], "encode", setting, stream, *inputs]
        target = ("--lossless",) if self.unit == "lossless" else ("--" + self.unit, setting)
        return [programs["reeb"], "encode", *inputs, "-o", stream, *target, *self.options, "--no-report",
                "--attribute", "*=drop",  # peers code positions alone
                "--group-length", "512", "-T", "1", "--json", "-q"]

    def decode_command(self, programs, stream, decoded):
        if self.peer:
            return [programs[self.peer + "_peer"], "decode", stream, decoded]
        return [programs["decode_positions"], stream, decoded]


def _reeb(name, words, *options, group="profile", targets=KG_TARGETS, **more):
    return Configuration(name, group, words, targets, options=options, **more)


def _peer(name, words, unit, targets, group="peer"):
    return Configuration(name, group, words, tuple(targets), unit=unit, peer=name.partition("-")[0])


ALL = (
    _reeb("reeb", "Reeb"),
    _reeb("reeb-reorder", "Reeb, vertex order dropped", "--reorder"),
    _reeb("reeb-fast", "Reeb, fast profile", "--profile", "fast"),
    _reeb("reeb-thesis", "Reeb, thesis configuration", "--profile", "thesis"),
    *(_reeb(f"reeb-effort-{e}", f"Reeb, effort {e}", "--effort", str(e), group="effort", targets=("0.5", "0.05"))
      for e in range(1, 10)),
    *(_reeb(f"without-{tool}", f"without {words}", group="ablation", targets=ABLATION_TARGETS, without=tool)
      for tool, words in TOOLS.items()),
    _reeb("without-motion", "without the motion model", "--regions", "0", group="ablation", targets=ABLATION_TARGETS),
    _reeb("reeb-bounded", "Reeb, error bounded", group="bounded", targets=("0.1%", "0.01%", "0.001%"),
          unit="max-error"),
    _reeb("reeb-lossless", "Reeb, lossless", group="lossless", targets=("",), unit="lossless"),
    _reeb("reeb-lossless-quick", "Reeb, lossless, effort 1", "--effort", "1", group="lossless", targets=("",),
          unit="lossless"),
    _peer("pca", "PCA with parallelograms", "kg", KG_TARGETS),
    _peer("draco", "Draco, frame by frame", "bits", map(str, range(7, 15))),
    _peer("meshopt", "meshoptimizer and zstd", "bits", map(str, range(7, 17))),
    _peer("zfp", "zfp", "accuracy", ("0.03", "0.01", "0.003", "0.001", "0.0003", "0.0001")),
    _peer("fpzip-lossless", "fpzip", "lossless", ("0",), group="lossless"),
    _peer("zfp-lossless", "zfp, reversible", "lossless", ("0",), group="lossless"),
)


def select(names):
    """Configurations by name or by group, in the order of ALL; all of them for `all`."""
    known = {c.name for c in ALL} | {c.group for c in ALL} | {"all"}
    unknown = [name for name in names if name not in known]
    if unknown:
        raise SystemExit(f"unknown configuration {unknown[0]}; known: {', '.join(c.name for c in ALL)}; "
                         f"groups: {', '.join(sorted({c.group for c in ALL}))}, all")
    return [c for c in ALL if {c.name, c.group, "all"} & set(names)]
