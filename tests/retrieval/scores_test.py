"""Measures of retrieval on rankings whose scores are known."""

import math
import pathlib
import sys
import unittest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / 'conformance' / 'retrieval'))
import retrieval
import scores


class Measures(unittest.TestCase):
    def test_perfect_ranking(self):
        nearest, first, second, e, dcg = scores.measures([1, 1, 1, 0, 0, 0])
        self.assertEqual((nearest, first, second, dcg), (1, 1, 1, 1))
        self.assertAlmostEqual(e, 2 * 0.5 * 1 / 1.5)  # all six are within 32: precision 1/2, recall 1

    def test_by_hand(self):
        nearest, first, second, e, dcg = scores.measures([0, 1, 0, 1] + 60 * [0])
        self.assertEqual((nearest, first, second), (0, 0.5, 1))
        self.assertAlmostEqual(e, 2 * (2 / 32) * 1 / (2 / 32 + 1))
        self.assertAlmostEqual(dcg, (1 / math.log2(2) + 1 / math.log2(4)) / (1 + 1 / math.log2(2)))

    def test_curve_keeps_the_best_precision_beyond(self):
        curve = scores.precision_recall([0, 1, 1, 0])
        self.assertAlmostEqual(curve[0], 2 / 3)
        self.assertAlmostEqual(curve[-1], 2 / 3)

    def test_query_is_ranked_by_distance(self):
        distances = [[0, 3, 1, 2]]
        self.assertEqual(scores.ranked_relevance(distances, ['a', 'a', 'b', 'a'], 0, [1, 2, 3]), [0, 1, 1])

    def test_queries_without_class_mates_do_not_count(self):
        distances = [[0, 1, 2], [1, 0, 2], [2, 2, 0]]
        everything = range(3)
        values, _ = scores.evaluate(distances, ['a', 'a', 'b'], everything, lambda q: [i for i in everything if i != q])
        self.assertEqual(values[0], 1)

    def test_variants_are_measured_against_what_they_are_made_of(self):
        items = [('a', 'f', '1', '-'), ('a', 'g', '1', '-'), ('b', 'h', '1', '-'), ('a', 'f', '1', 'half')]
        distances = [[0, 1, 2, 0.5], [1, 0, 4, 1], [2, 4, 0, 0.2], [0.5, 1, 0.2, 0]]
        pose, half = retrieval.invariance({'any': distances}, items)  # classes are 3 from each other in the mean
        self.assertEqual(pose[:3], ('pose', 'any', 3))
        self.assertAlmostEqual(pose[3], 1 / 3)
        self.assertAlmostEqual(pose[5], 2 / 3)  # the nearest of h is of another class
        self.assertEqual(half[:3], ('half', 'any', 1))
        self.assertAlmostEqual(half[3], 0.5 / 3)
        self.assertEqual(half[4:], (0, 0))  # h is nearer than f


if __name__ == '__main__':
    unittest.main()
