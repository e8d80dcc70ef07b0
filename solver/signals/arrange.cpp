// The order of evaluation: a depth-first walk against the arrows, which meets itself where there is an algebraic loop.
#include <algorithm>
#include <functional>

#include "solver/signals/graph.hpp"

namespace bough::solver {
namespace {

enum class Mark : unsigned char { White, Grey, Black };

/// Nodes are blocks, the last one the accelerations.
class Walk {
 public:
  Walk(std::vector<std::vector<int>> sources, std::vector<std::string> names)
      : sources_(std::move(sources)), names_(std::move(names)), mark_(sources_.size(), Mark::White) {}

  /// Nodes, each after its sources; empty `loop` when there is none.
  std::vector<int> sort(std::string& loop) {
    for (size_t i = 0; i < sources_.size() && loop.empty(); ++i) visit(static_cast<int>(i), loop);
    return order_;
  }

 private:
  void visit(int node, std::string& loop) {
    auto& mark = mark_[static_cast<size_t>(node)];
    if (mark == Mark::Black || !loop.empty()) return;
    if (mark == Mark::Grey) {
      // The path was walked from sinks to sources.
      loop = names_[static_cast<size_t>(node)];
      for (size_t i = path_.size(); i-- > 0;) {
        loop += " -> " + names_[static_cast<size_t>(path_[i])];
        if (path_[i] == node) return;
      }
      return;
    }
    mark = Mark::Grey;
    path_.push_back(node);
    for (const int source : sources_[static_cast<size_t>(node)]) visit(source, loop);
    path_.pop_back();
    mark = Mark::Black;
    order_.push_back(node);
  }

  std::vector<std::vector<int>> sources_;
  std::vector<std::string> names_;
  std::vector<Mark> mark_;
  std::vector<int> path_, order_;
};

}  // namespace

void SignalGraph::arrange(Diagnostics& diagnostics) {
  const auto n = places.size();
  std::vector<int> block_of(static_cast<size_t>(num_values));
  for (size_t i = 0; i < n; ++i)
    std::fill_n(block_of.begin() + places[i].out, places[i].block->sizes.outputs, static_cast<int>(i));
  // At any moment, and at instants of samples, where the accelerations are those before them.
  std::vector<std::vector<int>> moment(n + 1), instant(n);
  std::vector<std::string> names;
  for (size_t i = 0; i < n; ++i) {
    const BlockSlot& p = places[i];
    const BlockSizes& sizes = p.block->sizes;
    names.push_back(p.block->name);
    if (p.actuator >= 0) moment[n].push_back(static_cast<int>(i));
    if (!sizes.has_feedthrough || (p.is_sampled() && sizes.delay > 0)) continue;
    for (const int row : p.sources) {
      const int source = block_of[static_cast<size_t>(row)];
      instant[i].push_back(source);
      if (!p.is_sampled()) moment[i].push_back(source);
    }
    if (sizes.reads_acceleration && !p.is_sampled()) moment[i].push_back(static_cast<int>(n));
  }
  names.push_back("the accelerations");
  std::string loop;
  std::vector<int> late_order = Walk(moment, names).sort(loop);
  if (loop.empty()) {
    names.pop_back();
    order = Walk(instant, names).sort(loop);
  }
  if (!loop.empty()) {
    const auto first = std::find_if(places.begin(), places.end(),
                                    [&](const auto& p) { return loop.rfind(p.block->name + " -> ", 0) == 0; });
    diagnostics.error("control.algebraic-loop", first == places.end() ? places.front().block->at : first->block->at,
                      "algebraic loop: " + loop, "put a lag or a delay into one of them");
    order.clear();
    return;
  }
  // Blocks that depend on accelerations are computed after them.
  for (const int i : late_order) {
    if (i == static_cast<int>(n)) continue;
    const auto& sources = moment[static_cast<size_t>(i)];
    places[static_cast<size_t>(i)].needs_acceleration = std::any_of(sources.begin(), sources.end(), [&](int source) {
      return source == static_cast<int>(n) || places[static_cast<size_t>(source)].needs_acceleration;
    });
  }
  find_needed();
}

void SignalGraph::find_needed() {
  std::vector<int> block_of(static_cast<size_t>(num_values));
  for (size_t i = 0; i < places.size(); ++i)
    std::fill_n(block_of.begin() + places[i].out, places[i].block->sizes.outputs, static_cast<int>(i));
  const std::function<void(size_t)> need = [&](size_t i) {
    BlockSlot& p = places[i];
    if (p.drives_motion) return;
    p.drives_motion = true;
    if (p.is_sampled() && p.block->sizes.states == 0) return;  // its inputs are read at its samples
    for (const int row : p.sources) need(static_cast<size_t>(block_of[static_cast<size_t>(row)]));
  };
  for (size_t i = 0; i < places.size(); ++i) {
    if (places[i].actuator >= 0 || places[i].block->sizes.states > 0) need(i);
  }
}

}  // namespace bough::solver
