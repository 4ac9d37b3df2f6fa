"""What the report says, computed from the table: no markup here."""
import statistics

import bd_rate
import configurations
import curves

BY_NAME = {c.name: c for c in configurations.ALL}
DRAWN = ("reeb", "reeb-fast", "reeb-thesis", "pca", "draco", "meshopt", "zfp")
MEASURES = {"kg": "KG error, percent", "sted": "STED", "max_error": "largest error"}


class Results:
    """The lines of a table, by sequence and configuration."""

    def __init__(self, rows):
        self.rows = rows
        self.sequences = sorted({row["sequence"] for row in rows.values()})
        present = {row["configuration"] for row in rows.values()}
        self.configurations = [c for c in configurations.ALL if c.name in present]

    def of(self, sequence, configuration):
        return [row for row in self.rows.values()
                if row["sequence"] == sequence and row["configuration"] == configuration]

    def group(self, name):
        return [c for c in self.configurations if c.group == name]

    def points(self, sequence, configuration, measure="kg"):
        """(rate, error) pairs."""
        return [(row["bpvf"], row[measure]) for row in self.of(sequence, configuration)]

    def at(self, sequence, configuration, target):
        return self.rows.get((sequence, configuration, target))

    def curves(self, sequence, measure):
        drawn = []
        for name in DRAWN + (("reeb-bounded",) if measure == "max_error" else ()):
            points = [(row["bpvf"], row[measure],
                       f"{BY_NAME[name].words}, {row['target']}: {row['bpvf']:.4g} bits, "
                       f"{MEASURES[measure]} {row[measure]:.3g}")
                      for row in self.of(sequence, name) if row[measure] > 0]
            if points:
                drawn.append(curves.Curve(name, BY_NAME[name].words, points))
        return drawn

    def bd_rates(self, anchor="reeb", measure="kg"):
        """{configuration: {sequence: percent more rate than the anchor}} of the other curves."""
        out = {}
        for c in self.configurations:
            if c.name == anchor or c.group not in ("profile", "peer"):
                continue
            if measure == "sted" and not c.keeps_order:
                continue
            out[c.name] = {s: bd_rate.bd_rate(self.points(s, anchor, measure), self.points(s, c.name, measure))
                           for s in self.sequences}
        return out

    def times_the_rate(self, name, kg):
        """How many times Reeb's rate a codec takes at a KG error, by sequence, by interpolation."""
        out = {}
        for s in self.sequences:
            other, own = (bd_rate.rate_at(self.points(s, n), kg) for n in (name, "reeb"))
            if other and own:
                out[s] = other / own
        return out

    def ablations(self):
        """{configuration: {target: [(sequence, percent more rate than with the tool), ...]}}"""
        out = {}
        for c in self.group("ablation"):
            for setting in c.targets:
                target = c.target_of(setting)
                pairs = [(s, self.at(s, "reeb", target), self.at(s, c.name, target)) for s in self.sequences]
                out.setdefault(c.name, {})[target] = [(s, 100 * (less["bytes"] / full["bytes"] - 1))
                                                      for s, full, less in pairs if full and less]
        return out

    def efforts(self):
        """(configuration, rate against the default, encoding time against it), means over what both measured."""
        out = []
        for c in self.group("effort"):
            rates, times = [], []
            for s in self.sequences:
                for row in self.of(s, c.name):
                    base = self.at(s, "reeb", row["target"])
                    if base:
                        rates.append(row["bytes"] / base["bytes"])
                        times.append(row["encode_s"] / base["encode_s"])
            if rates:
                out.append((c, statistics.geometric_mean(rates), statistics.geometric_mean(times)))
        return out
