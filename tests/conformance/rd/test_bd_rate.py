"""Interpolation and BD-rate against values worked out by hand."""
import math
import os
import sys
import unittest

sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "..", "conformance", "rd"))

import bd_rate  # noqa: E402


class MonotoneCubicTest(unittest.TestCase):
    def test_goes_through_its_points(self):
        f = bd_rate.MonotoneCubic([0, 1, 3, 4], [2, 5, 6, 6.5])
        for x, y in ((0, 2), (1, 5), (3, 6), (4, 6.5)):
            self.assertAlmostEqual(f(x), y, places=12)

    def test_is_exact_on_a_line(self):
        f = bd_rate.MonotoneCubic([0, 1, 5, 6], [1, 3, 11, 13])
        self.assertAlmostEqual(f(2.5), 6, places=12)
        self.assertAlmostEqual(f.integral(0.5, 5.5), 35, places=12)  # mean 7 over a width of 5

    def test_slopes_by_hand(self):
        # Differences 1 and 3 over equal steps: weights 3 and 3, so the inner slope is 6 / (3/1 + 3/3) = 1.5; at the
        # left (3 * 1 - 1 * 3) / 2 = 0, at the right (3 * 3 - 1 * 1) / 2 = 4.
        f = bd_rate.MonotoneCubic([0, 1, 2], [0, 1, 4])
        self.assertEqual(f.slope, [0, 1.5, 4])
        # Hermite on [1, 2] in the middle: (1 + 4) / 2 + (1.5 - 4) / 8.
        self.assertAlmostEqual(f(1.5), 2.5 - 0.3125, places=12)

    def test_integral_by_hand(self):
        # Of a Hermite piece of width 1: (y0 + y1) / 2 + (m0 - m1) / 12.
        f = bd_rate.MonotoneCubic([0, 1, 2], [0, 1, 4])
        self.assertAlmostEqual(f.integral(0, 1), 0.5 + (0 - 1.5) / 12, places=12)
        self.assertAlmostEqual(f.integral(0, 2), 0.5 - 0.125 + 2.5 - 2.5 / 12, places=12)

    def test_does_not_overshoot_a_step(self):
        f = bd_rate.MonotoneCubic([0, 1, 2, 3], [0, 0, 1, 1])
        values = [f(x / 50) for x in range(151)]
        self.assertGreaterEqual(min(values), -1e-12)
        self.assertLessEqual(max(values), 1 + 1e-12)
        self.assertTrue(all(b > a - 1e-12 for a, b in zip(values, values[1:])))


class BdRateTest(unittest.TestCase):
    ANCHOR = [(1, 1), (2, 0.5), (4, 0.2), (8, 0.1), (16, 0.05)]

    def test_equal_curves_differ_by_nothing(self):
        self.assertAlmostEqual(bd_rate.bd_rate(self.ANCHOR, self.ANCHOR), 0, places=9)

    def test_a_constant_factor_comes_out(self):
        other = [(1.25 * rate, error) for rate, error in reversed(self.ANCHOR)]
        self.assertAlmostEqual(bd_rate.bd_rate(self.ANCHOR, other), 25, places=9)
        self.assertAlmostEqual(bd_rate.bd_rate(other, self.ANCHOR), -20, places=9)

    def test_power_laws_by_hand(self):
        # ln rate = -ln error against -2 ln error over errors from e^-3 to 1: the mean of -ln error there is 1.5.
        errors = [math.exp(-i) for i in range(4)]
        one, two = [(1 / e, e) for e in errors], [(1 / e**2, e) for e in errors]
        self.assertAlmostEqual(bd_rate.bd_rate(one, two), 100 * (math.exp(1.5) - 1), places=8)

    def test_only_what_both_reach_counts(self):
        # Twice the rate where they overlap, whatever the other does beyond.
        errors = [math.exp(-i) for i in range(8)]
        anchor = [(1 / e, e) for e in errors[:5]]
        other = [(2 / e, e) for e in errors[2:]]
        self.assertAlmostEqual(bd_rate.bd_rate(anchor, other), 100, places=8)

    def test_none_where_there_is_too_little(self):
        self.assertIsNone(bd_rate.bd_rate(self.ANCHOR[:3], self.ANCHOR))
        self.assertIsNone(bd_rate.bd_rate(self.ANCHOR, [(r, e / 1000) for r, e in self.ANCHOR]))
        self.assertIsNone(bd_rate.bd_rate(self.ANCHOR, [(5, 0)] * 5))

    def test_rate_at_an_error(self):
        self.assertAlmostEqual(bd_rate.rate_at(self.ANCHOR, 0.2), 4, places=9)
        self.assertIsNone(bd_rate.rate_at(self.ANCHOR, 0.001))
        between = bd_rate.rate_at([(1 / e, e) for e in (1, 0.5, 0.2, 0.1)], 0.3)
        self.assertAlmostEqual(between, 1 / 0.3, places=9)


if __name__ == "__main__":
    unittest.main()
