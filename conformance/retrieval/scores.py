"""Measures of retrieval: leave one out, the rest ranked by distance."""

import math

MEASURES = ('nearest neighbour', 'first tier', 'second tier', 'e-measure', 'DCG')
E_MEASURE_RANKS = 32
RECALL_STEPS = 20


def ranked_relevance(distances, kinds, query, candidates):
    """1 or 0 for each candidate, nearest first."""
    others = sorted((distances[query][i], i) for i in candidates)
    return [int(kinds[i] == kinds[query]) for _, i in others]


def measures(relevance):
    """Of one query, in the order of MEASURES; its class has another member."""
    wanted = sum(relevance)
    found = relevance[:E_MEASURE_RANKS]
    precision, recall = sum(found) / len(found), sum(found) / wanted
    discount = [1.0] + [1 / math.log2(rank) for rank in range(2, len(relevance) + 1)]
    gain = sum(r * d for r, d in zip(relevance, discount))
    return (float(relevance[0]),
            sum(relevance[:wanted]) / wanted,
            sum(relevance[:2 * wanted]) / wanted,
            2 * precision * recall / (precision + recall) if precision + recall > 0 else 0.0,
            gain / sum(discount[:wanted]))


def precision_recall(relevance):
    """Best precision at every recall of 1/RECALL_STEPS, 2/RECALL_STEPS .. 1 or more."""
    wanted, hits, points = sum(relevance), 0, []
    for rank, relevant in enumerate(relevance, 1):
        hits += relevant
        if relevant:
            points.append((hits / wanted, hits / rank))
    return [max(p for r, p in points if r >= step / RECALL_STEPS - 1e-9) for step in range(1, RECALL_STEPS + 1)]


def nearest(distances, query, candidates):
    return min((distances[query][i], i) for i in candidates)[1]


def mean(values):
    values = list(values)
    return sum(values) / len(values) if values else math.nan


def mean_rows(rows):
    return [sum(column) / len(rows) for column in zip(*rows)]


def evaluate(distances, kinds, queries, candidates):
    """Mean measures and precision-recall curve over the queries that have something to find; `candidates` gives those of a query."""
    all_measures, curves = [], []
    for query in queries:
        relevance = ranked_relevance(distances, kinds, query, candidates(query))
        if sum(relevance) == 0:
            continue
        all_measures.append(measures(relevance))
        curves.append(precision_recall(relevance))
    return mean_rows(all_measures), mean_rows(curves)
