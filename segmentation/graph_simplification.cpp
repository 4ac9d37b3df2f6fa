#include "segmentation/graph_simplification.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "segmentation/union_find.h"

namespace reeb::segmentation {
namespace {

class Simplifier {
 public:
  Simplifier(const ReebGraph& graph, const std::vector<bool>& keep, double persistence)
      : graph_(graph),
        keep_(keep),
        persistence_(persistence),
        incident_(graph.nodes.size()),
        merged_(static_cast<uint32_t>(graph.arcs.size())),
        contracted_(static_cast<uint32_t>(graph.nodes.size())),
        shrunk_into_(graph.arcs.size(), kNone),
        dissolved_into_(graph.nodes.size(), kNone),
        alive_(graph.arcs.size(), true) {
    for (uint32_t a = 0; a < graph.arcs.size(); ++a) {
      const auto [low, high] = graph.arcs[a];
      const double bottom = graph.nodes[low].value, top = graph.nodes[high].value;
      arcs_.push_back({low, high, bottom, top, top - bottom});
      incident_[low].push_back(a);
      incident_[high].push_back(a);
      queue_.insert({arcs_[a].length, a});
    }
  }

  SimplifiedGraph run() {
    for (uint32_t n = 0; n < incident_.size(); ++n) dissolve(n);
    while (!queue_.empty() && queue_.begin()->first < persistence_) {
      const uint32_t arc = queue_.begin()->second;
      queue_.erase(queue_.begin());
      cancel(arc);
    }
    return collect();
  }

 private:
  size_t degree(uint32_t node) const { return incident_[node].size(); }

  void cancel(uint32_t arc) {
    const uint32_t from = arcs_[arc].from, to = arcs_[arc].to;
    if (from == to) return;
    const bool leaf_from = degree(from) == 1, leaf_to = degree(to) == 1;
    if (leaf_from && leaf_to) return;
    const uint32_t stays = leaf_from ? to : from, vanishes = leaf_from ? from : to;
    if ((leaf_from || leaf_to) && keep_[vanishes]) return;
    remove(arc);
    move_arcs(vanishes, stays);
    contracted_.unite(stays, vanishes);
    shrunk_into_[arc] = stays;
    dissolve(stays);
  }

  void remove(uint32_t arc) {
    alive_[arc] = false;
    queue_.erase({arcs_[arc].length, arc});
    for (const uint32_t node : {arcs_[arc].from, arcs_[arc].to}) std::erase(incident_[node], arc);
  }

  void move_arcs(uint32_t node, uint32_t target) {
    for (const uint32_t arc : incident_[node]) {
      if (arcs_[arc].from == node) arcs_[arc].from = target;
      if (arcs_[arc].to == node) arcs_[arc].to = target;
      incident_[target].push_back(arc);
    }
    incident_[node].clear();
  }

  // Makes one arc of the two that meet at a node of degree two.
  void dissolve(uint32_t node) {
    if (degree(node) != 2 || incident_[node][0] == incident_[node][1]) return;
    const uint32_t first = incident_[node][0], second = incident_[node][1];
    const SimplifiedGraph::Arc a = seen_from(first, node), b = seen_from(second, node);
    remove(first);
    remove(second);
    alive_[first] = true;
    merged_.unite(first, second);
    dissolved_into_[node] = first;
    arcs_[first] = {a.to, b.to, a.to_value, b.to_value, a.length + b.length};
    incident_[a.to].push_back(first);
    incident_[b.to].push_back(first);
    queue_.insert({arcs_[first].length, first});
  }

  // The arc in the direction that starts at `node`.
  SimplifiedGraph::Arc seen_from(uint32_t arc, uint32_t node) const {
    SimplifiedGraph::Arc a = arcs_[arc];
    if (a.from != node) {
      std::swap(a.from, a.to);
      std::swap(a.from_value, a.to_value);
    }
    return a;
  }

  SimplifiedGraph collect() {
    SimplifiedGraph result;
    std::vector<uint32_t> node_index(incident_.size(), kNone), arc_index(arcs_.size(), kNone);
    for (uint32_t n = 0; n < incident_.size(); ++n) {
      if (incident_[n].empty()) continue;
      node_index[n] = static_cast<uint32_t>(result.nodes.size());
      result.nodes.push_back(graph_.nodes[n]);
    }
    for (uint32_t a = 0; a < arcs_.size(); ++a) {
      if (!alive_[a]) continue;
      arc_index[a] = static_cast<uint32_t>(result.arcs.size());
      result.arcs.push_back(arcs_[a]);
      result.arcs.back().from = node_index[arcs_[a].from];
      result.arcs.back().to = node_index[arcs_[a].to];
    }
    for (uint32_t a = 0; a < arcs_.size(); ++a) {
      const auto [arc, node] = destination(a);
      result.arc_of.push_back(arc == kNone ? kNone : arc_index[arc]);
      result.node_of.push_back(node == kNone ? kNone : node_index[node]);
    }
    return result;
  }

  // The arc (first) or the node (second) that an arc of the input ended in; the other is kNone.
  std::pair<uint32_t, uint32_t> destination(uint32_t arc) {
    for (;;) {
      arc = merged_.find(arc);
      if (alive_[arc]) return {arc, kNone};
      const uint32_t node = contracted_.find(shrunk_into_[arc]);
      if (dissolved_into_[node] == kNone) return {kNone, node};
      arc = dissolved_into_[node];
    }
  }

  const ReebGraph& graph_;
  const std::vector<bool>& keep_;
  double persistence_;
  std::vector<std::vector<uint32_t>>
      incident_;                          // arcs at each node; one that returns is there twice
  UnionFind merged_;                      // a living arc represents those joined to it
  UnionFind contracted_;                  // a living node represents those contracted into it
  std::vector<uint32_t> shrunk_into_;     // node of a cancelled arc
  std::vector<uint32_t> dissolved_into_;  // arc of a node of degree two
  std::vector<bool> alive_;
  std::vector<SimplifiedGraph::Arc> arcs_;
  std::set<std::pair<double, uint32_t>> queue_;
};

}  // namespace

uint32_t SimplifiedGraph::degree(uint32_t node) const {
  uint32_t degree = 0;
  for (const Arc& arc : arcs) degree += (arc.from == node) + (arc.to == node);
  return degree;
}

SimplifiedGraph simplify(const ReebGraph& graph, const std::vector<bool>& keep,
                         double persistence) {
  return Simplifier(graph, keep, persistence).run();
}

}  // namespace reeb::segmentation
