#include "analysis/select/exchange.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace bough::analysis {

namespace {

/// Search for modes that lose less than those chosen by cost: every step takes the change of least loss.
class Exchange {
 public:
  /// Relative difference of losses that is no difference.
  static constexpr double kCloseness = 1e-7;

  Exchange(const std::vector<Weighing>& weighings, Events& events, Selection& s)
      : weighings_(weighings), events_(events), s_(s) {}

  /// Exchanges pairs as long as the loss falls.
  void exchange() {
    for (;;) {
      std::vector<Change> changes;
      for (const int in : list(false))
        for (const int out : list(true)) changes.push_back({in, out});
      const auto best = find_best(changes);
      if (!best || best->lost >= s_.lost * (1 - kCloseness)) return;
      accept(*best, best->out);
    }
  }

  /// Drops modes as long as the loss is within the tolerance. \return true if any was dropped.
  bool drop(double tolerance) {
    for (bool has_dropped = false;; has_dropped = true) {
      std::vector<Change> changes;
      for (const int out : list(true)) changes.push_back({-1, out});
      const auto best = find_best(changes);
      if (!best || best->lost > tolerance || s_.kept.size() < 2) return has_dropped;
      accept(*best, best->out);
    }
  }

 private:
  struct Change {
    int in = -1, out = -1;
    double lost = 0;
  };

  /// Modes that costs have decided about.
  std::vector<int> list(bool is_kept) const {
    std::vector<int> modes;
    for (std::size_t i = 0; i < s_.choices.size(); ++i)
      if (s_.choices[i].by_cost && s_.choices[i].kept == is_kept) modes.push_back(static_cast<int>(i));
    return modes;
  }

  std::vector<int> apply(const Change& change) const {
    std::vector<int> kept;
    for (const int mode : s_.kept)
      if (mode != change.out) kept.push_back(mode);
    if (change.in >= 0) kept.insert(std::lower_bound(kept.begin(), kept.end(), change.in), change.in);
    return kept;
  }

  /// The first of least loss.
  std::optional<Change> find_best(const std::vector<Change>& changes) const {
    std::optional<Change> best;
    for (std::size_t i = 0; i < changes.size(); ++i) {
      events_.show_progress(
          fmt::format("exchange of modes: {} of {}, {:.3g} % lost", i + 1, changes.size(), 100 * s_.lost));
      auto change = changes[i];
      change.lost = calc_lost(weighings_, apply(change));
      if (!best || change.lost < best->lost * (1 - kCloseness)) best = change;
    }
    events_.show_progress({});
    return best;
  }

  void accept(const Change& change, int out) {
    s_.kept = apply(change);
    s_.lost = change.lost;
    s_.choices[static_cast<std::size_t>(out)] = {false, "loses less without", false, true};
    if (change.in >= 0) s_.choices[static_cast<std::size_t>(change.in)] = {true, "loses less with", false, true};
  }

  const std::vector<Weighing>& weighings_;
  Events& events_;
  Selection& s_;
};

}  // namespace

void exchange_modes(const std::vector<Weighing>& weighings, std::optional<double> tolerance, Events& events,
                    Selection& selection) {
  Exchange search(weighings, events, selection);
  search.exchange();
  while (tolerance && search.drop(*tolerance)) search.exchange();
}

}  // namespace bough::analysis
