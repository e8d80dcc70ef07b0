#include "solver/builder/signal_units.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "formats/records/dims.hpp"

namespace bough::solver {
std::vector<std::string> split_dims(const std::string& dims, int outputs) {
  std::vector<std::string> parts;
  for (size_t from = 0; from <= dims.size();) {
    const size_t comma = std::min(dims.find(", ", from), dims.size());
    parts.push_back(dims.substr(from, comma - from));
    from = comma + 2;
  }
  const auto n = static_cast<size_t>(outputs);
  if (parts.size() == 1) parts.resize(n, parts.front());
  if (parts.size() != n) return std::vector<std::string>(n);
  for (auto& part : parts)
    if (!records::parse_dims(part)) part.clear();
  return parts;
}

bool are_alike_dims(const std::string& a, const std::string& b) {
  return a.empty() || b.empty() || records::parse_dims(a) == records::parse_dims(b);
}

std::string make_rate_dims(const std::string& a) {
  return a.empty() ? "" : a.find('/') == std::string::npos ? a + "/T" : a + " T";
}

namespace {

class Check {
 public:
  Check(const SignalGraph& graph, const std::vector<const records::ControllerRecord*>& records,
        Diagnostics& diagnostics)
      : graph_(graph), records_(records), diagnostics_(diagnostics), dims_(static_cast<size_t>(graph.num_values)) {
    for (const auto& p : graph.places)
      for (int i = 0; i < p.block->sizes.outputs; ++i) name_of_.push_back(p.block->name);
  }

  void run() {
    for (const int i : graph_.order) {
      const auto at = static_cast<size_t>(i);
      const BlockSlot& p = graph_.places[at];
      std::vector<std::string> out = split_dims(p.block->dims, p.block->sizes.outputs);
      if (records_[at] != nullptr) look_at_controller(p, *records_[at], out);
      if (p.actuator >= 0) look_at_actuator(p);
      std::copy(out.begin(), out.end(), dims_.begin() + p.out);
    }
  }

 private:
  std::string get(const BlockSlot& p, size_t input) const {
    return p.gains[input] != 1 ? "" : dims_[static_cast<size_t>(p.sources[input])];
  }
  std::string describe(const BlockSlot& p, size_t input) const {
    return name_of_[static_cast<size_t>(p.sources[input])] + " (" + get(p, input) + ")";
  }
  void warn(const BlockSlot& p, const std::string& what) {
    diagnostics_.warning("control.units", p.block->at, p.block->label + " " + what,
                         "check the connections; a gain changes the quantity");
  }
  void compare(const BlockSlot& p, size_t a, size_t b, const char* verb) {
    if (!are_alike_dims(get(p, a), get(p, b))) warn(p, verb + describe(p, a) + " and " + describe(p, b));
  }

  void look_at_controller(const BlockSlot& p, const records::ControllerRecord& r, std::vector<std::string>& out) {
    const size_t n = out.size();
    if (r.type == "limit") {
      for (size_t i = 0; i < n; ++i) out[i] = get(p, i);
    } else if (r.type == "sum" && !r.settings.has("weights")) {
      for (size_t i = 0; i < n; ++i) add_up(p, i, n, out[i]);
    } else if (r.type == "switch") {
      for (size_t i = 0; i < n; ++i) {
        out[i] = get(p, i);
        compare(p, i, n + i, "switches between ");
      }
    } else if (r.type == "pid") {
      const bool has_reference = p.sources.size() > n && (p.sources.size() == 3 * n || r.rate.empty());
      for (size_t i = 0; has_reference && i < n; ++i) compare(p, i, n + i, "compares ");
      for (size_t i = 0; !r.rate.empty() && i < n; ++i) {
        const size_t rate = p.sources.size() - n + i;
        if (!are_alike_dims(make_rate_dims(get(p, i)), get(p, rate)))
          warn(p, "takes " + describe(p, rate) + " for the rate of " + describe(p, i));
      }
    }
  }

  void add_up(const BlockSlot& p, size_t i, size_t n, std::string& sum) {
    size_t first = p.sources.size();
    for (size_t k = i; k < p.sources.size(); k += n) {
      if (get(p, k).empty()) continue;
      if (first == p.sources.size())
        first = k;
      else
        compare(p, first, k, "adds ");
    }
    if (first < p.sources.size()) sum = get(p, first);
  }

  void look_at_actuator(const BlockSlot& p) {
    for (size_t i = 0; i < p.sources.size(); ++i) {
      if (!are_alike_dims(p.block->input_dims, get(p, i)))
        warn(p, "takes " + p.block->input_dims + " and gets " + describe(p, i));
    }
  }

  const SignalGraph& graph_;
  const std::vector<const records::ControllerRecord*>& records_;
  Diagnostics& diagnostics_;
  std::vector<std::string> dims_, name_of_;
};

}  // namespace

void check_signal_units(const SignalGraph& graph, const std::vector<const records::ControllerRecord*>& records,
                        Diagnostics& diagnostics) {
  Check(graph, records, diagnostics).run();
}

}  // namespace bough::solver
