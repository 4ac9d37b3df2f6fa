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
        alive_(graph.arcs.size(), true) {
    for (uint32_t a = 0; a < graph.arcs.size(); ++a) {
      const auto [low, high] = graph.arcs[a];
      arcs_.push_back({low, high, graph.nodes[high].value - graph.nodes[low].value});
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
    const auto [from, to, length] = arcs_[arc];
    if (from == to) return;
    const bool leaf_from = degree(from) == 1, leaf_to = degree(to) == 1;
    if (leaf_from && leaf_to) return;
    if (leaf_from || leaf_to) {
      const uint32_t leaf = leaf_from ? from : to;
      if (keep_[leaf]) return;
      remove(arc);
      dissolve(leaf_from ? to : from);
    } else {
      remove(arc);
      move_arcs(to, from);
      dissolve(from);
    }
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
    const uint32_t from = other_end(first, node), to = other_end(second, node);
    const double length = arcs_[first].length + arcs_[second].length;
    remove(first);
    remove(second);
    alive_[first] = true;
    merged_.unite(first, second);
    arcs_[first] = {from, to, length};
    incident_[from].push_back(first);
    incident_[to].push_back(first);
    queue_.insert({length, first});
  }

  uint32_t other_end(uint32_t arc, uint32_t node) const {
    return arcs_[arc].from == node ? arcs_[arc].to : arcs_[arc].from;
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
      result.arcs.push_back({node_index[arcs_[a].from], node_index[arcs_[a].to], arcs_[a].length});
    }
    for (uint32_t a = 0; a < arcs_.size(); ++a) {
      result.arc_of.push_back(arc_index[merged_.find(a)]);
    }
    return result;
  }

  const ReebGraph& graph_;
  const std::vector<bool>& keep_;
  double persistence_;
  std::vector<std::vector<uint32_t>>
      incident_;      // arcs at each node; one that returns is there twice
  UnionFind merged_;  // a living arc represents those joined to it
  std::vector<bool> alive_;
  std::vector<SimplifiedGraph::Arc> arcs_;
  std::set<std::pair<double, uint32_t>> queue_;
};

}  // namespace

SimplifiedGraph simplify(const ReebGraph& graph, const std::vector<bool>& keep,
                         double persistence) {
  return Simplifier(graph, keep, persistence).run();
}

}  // namespace reeb::segmentation
