#include "modal/response/frequency_list.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "formats/records/params.hpp"

namespace bough::modal::response {
namespace {

using records::FrequencyList;

/// FREQ3: f = ½(f1 + f2) + ½(f2 - f1) |ξ|^(1/CLUSTER) sign ξ, ξ from -1 to 1, of each piece between natural
/// frequencies; of their logarithms where TYPE is LOG.
void add_between(const FrequencyList& list, const VectorXd& natural_hz, std::vector<double>& hz) {
  std::vector<double> ends{list.f1};
  for (const double f : natural_hz)
    if (f > list.f1 && f < list.f2) ends.push_back(f);
  ends.push_back(list.f2);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    const double a = list.is_log ? std::log(ends[i - 1]) : ends[i - 1];
    const double b = list.is_log ? std::log(ends[i]) : ends[i];
    for (int k = 0; k < list.count; ++k) {
      const double xi = -1 + 2.0 * k / (list.count - 1);
      const double f = 0.5 * (a + b) + 0.5 * (b - a) * std::copysign(std::pow(std::abs(xi), 1 / list.spread), xi);
      hz.push_back(list.is_log ? std::exp(f) : f);
    }
  }
}

void add_frequencies(const FrequencyList& list, const VectorXd& natural_hz, std::vector<double>& hz) {
  switch (list.kind) {
    case 0:
      hz.insert(hz.end(), list.values.begin(), list.values.end());
      return;
    case 1:
      for (int i = 0; i <= list.count; ++i) hz.push_back(list.f1 + i * list.f2);
      return;
    case 2:
      for (int i = 0; i <= list.count; ++i)
        hz.push_back(list.f1 * std::exp(std::log(list.f2 / list.f1) * i / list.count));
      return;
    case 3:
      return add_between(list, natural_hz, hz);
    default:
      break;
  }
  // Every frequency between F1 and F2 counts, whatever its mode (MSC Quick Reference Guide, FREQ4, FREQ5).
  const double slack = 1e-12;
  const auto add = [&](double f) {
    if (f >= list.f1 * (1 - slack) && f <= list.f2 * (1 + slack)) hz.push_back(f);
  };
  for (const double f : natural_hz) {
    if (!(f > 0)) continue;
    if (list.kind == 5) {
      for (const double fraction : list.values) add(fraction * f);
      continue;
    }
    const int half = list.count / 2;  // an even NFM is one more
    for (int k = -half; k <= half; ++k) add(f * (1 + (half > 0 ? list.spread * k / half : 0)));
  }
}

/// OFREQ: of each frequency of its SET the nearest.
std::vector<double> choose_shown(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                                 const std::vector<double>& hz, Diagnostics& diagnostics) {
  const auto& sets = subcase.dynamics.sets;
  const auto set = sets.find(subcase.dynamics.ofreq);
  if (set == sets.end()) {
    diagnostics.error(
        "modal.missing-set", deck.locate(subcase.find_command("OFREQ")),
        "OFREQ = " + std::to_string(subcase.dynamics.ofreq) + " names a SET that the case control does not define",
        "write SET n = frequencies, or OFREQ = ALL");
    return hz;
  }
  std::vector<double> shown;
  const auto is_nearer = [](double f, double a, double b) { return std::abs(a - f) < std::abs(b - f); };
  for (const auto& range : set->second.ranges)
    if (!range.is_excluded)
      shown.push_back(
          *std::min_element(hz.begin(), hz.end(), [&](double a, double b) { return is_nearer(range.first, a, b); }));
  std::sort(shown.begin(), shown.end());
  shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
  return set->second.is_all || shown.empty() ? hz : shown;
}

}  // namespace

double find_highest(const records::DynamicDeck& deck, int set) {
  double highest = 0;
  for (const auto& list : deck.dynamics.frequencies) {
    if (list.sid != set) continue;
    for (const double f : list.values) highest = std::max(highest, list.kind == 0 ? f : 0.0);
    if (list.kind == 1) highest = std::max(highest, list.f1 + list.count * list.f2);
    if (list.kind <= 1 || list.f2 >= 1e19) continue;
    // The lowest that a mode gives may be the one between F1 and F2.
    double share = list.kind == 4 && list.count > 1 ? 1 - list.spread : 1;
    if (list.kind == 5) share = *std::min_element(list.values.begin(), list.values.end());
    highest = std::max(highest, share > 0 && share < 1 ? list.f2 / share : list.f2);
  }
  return highest;
}

VectorXd make_frequencies(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                          const VectorXd& natural_hz, Diagnostics& diagnostics) {
  const int set = subcase.dynamics.frequency;
  const auto where = deck.locate(subcase.find_command("FREQUENCY"));
  std::vector<double> hz;
  bool is_found = false;
  for (const auto& list : deck.dynamics.frequencies) {
    if (list.sid != set) continue;
    is_found = true;
    add_frequencies(list, natural_hz, hz);
  }
  if (set == 0 || !is_found) {
    diagnostics.error("modal.no-frequencies", where,
                      set == 0 ? "subcase " + std::to_string(subcase.id) + " selects no frequencies"
                               : "FREQUENCY = " + std::to_string(set) + " names no FREQ card of the deck",
                      "write FREQUENCY = n in the case control and FREQ, FREQ1, ... with this id");
    return {};
  }
  if (hz.empty())
    diagnostics.error(
        "modal.no-frequencies", where,
        "the FREQ cards of set " + std::to_string(set) + " give no frequency: no mode lies in their range",
        "widen F1 to F2, or take more modes");
  if (hz.empty()) return {};
  std::sort(hz.begin(), hz.end());
  const double min_distance = records::get_real_param(deck, "DFREQ", 1e-5, diagnostics) * (hz.back() - hz.front());
  std::vector<double> kept;
  for (const double f : hz)
    if (kept.empty() || f - kept.back() > min_distance) kept.push_back(f);
  if (subcase.dynamics.ofreq != 0) kept = choose_shown(deck, subcase, kept, diagnostics);
  return Eigen::Map<const VectorXd>(kept.data(), static_cast<Eigen::Index>(kept.size()));
}

TimeGrid make_times(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                    Diagnostics& diagnostics) {
  const int set = subcase.dynamics.tstep;
  const auto& all = deck.dynamics.steps;
  // TSTEPNL has negative ids; a deck with one kind of card may select it by either command.
  const auto find = [&](int sid) {
    return std::find_if(all.begin(), all.end(), [&](auto& s) { return s.sid == sid; });
  };
  const auto card = find(set) == all.end() ? find(-set) : find(set);
  const std::string name = set < 0 ? "TSTEPNL" : "TSTEP";
  TimeGrid grid;
  if (set == 0 || card == all.end()) {
    diagnostics.error("modal.no-time-steps", deck.locate(subcase.find_command("TSTEP")),
                      set == 0
                          ? "subcase " + std::to_string(subcase.id) + " selects no time steps"
                          : name + " = " + std::to_string(std::abs(set)) + " names no " + name + " card of the deck",
                      "write " + name + " = n in the case control and a " + name + " card with this id");
    return grid;
  }
  std::vector<double> time{0};
  grid.shown.push_back(0);
  for (const auto& part : card->parts) {
    const double start = time.back();
    for (int i = 1; i <= part.count; ++i) {
      time.push_back(start + i * part.step);
      if (i % part.every == 0 || i == part.count) grid.shown.push_back(static_cast<int>(time.size()) - 1);
    }
  }
  grid.time = Eigen::Map<const VectorXd>(time.data(), static_cast<Eigen::Index>(time.size()));
  return grid;
}

}  // namespace bough::modal::response
