#include "modal/response/random/random_response.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "formats/records/group_names.hpp"
#include "modal/response/random/modal_integral.hpp"
#include "modal/response/random/number_text.hpp"

namespace bough::modal::response {
namespace {

using Eigen::Index;
using records::RandomCurves;
using Responses = std::vector<const records::ResponseSubcase*>;

/// RMS values below this share of the largest of their quantity are round-off.
constexpr double kNoise = 1e-6;

/// One set of curves of all subcases.
struct CurveSet {
  RandomCurves curves;
  std::vector<const MatrixXd*> real, imag;  ///< by subcase
  std::vector<std::size_t> maps;            ///< index among the maps of the subcase
  std::vector<OutputForm> forms;
  Index num_components = 1;
};

VectorXd calc_roots(const VectorXd& squares) { return squares.cwiseMax(0.0).cwiseSqrt(); }

VectorXd calc_crossings(const SpectralMoments& moments) {
  VectorXd hz(moments.m0.size());
  for (Index i = 0; i < hz.size(); ++i)
    hz(i) = moments.m0(i) > 0 ? std::sqrt(std::max(moments.m2(i), 0.0) / moments.m0(i)) : 0;
  return hz;
}

template <class Curves, class IsSame>
bool find_others(const Responses& responses, std::vector<Curves> records::ResponseSubcase::*list,
                 std::size_t num_before, const IsSame& is_same, CurveSet& set) {
  for (const auto* response : responses) {
    const auto& all = response->*list;
    const auto found = std::find_if(all.begin(), all.end(), is_same);
    if (found == all.end()) return false;
    set.real.push_back(&found->real);
    set.imag.push_back(&found->imag);
    const auto before = num_before > 0 ? response->curves.size() : 0;
    set.maps.push_back(before + static_cast<std::size_t>(found - all.begin()));
  }
  return true;
}

/// Lists the curves that all subcases have; warns of the others.
std::vector<CurveSet> list_sets(const Responses& responses, const SourceLocation& at, Diagnostics& diagnostics) {
  std::vector<CurveSet> sets;
  const auto report = [&](const std::string& name) {
    diagnostics.warning("modal.random-output", at,
                        name +
                            " is not requested for the same grids or elements in every subcase of RANDPS: it has no "
                            "random response",
                        "write the output requests above the subcases");
  };
  for (const auto& first : responses.front()->curves) {
    CurveSet set;
    set.curves.quantity = first.quantity;
    set.curves.dofs = first.dofs;
    set.forms = list_output_forms({first.quantity}, false);
    const auto is_same = [&](const auto& other) {
      return other.quantity == first.quantity && other.dofs == first.dofs;
    };
    if (find_others(responses, &records::ResponseSubcase::curves, 0, is_same, set))
      sets.push_back(std::move(set));
    else
      report(first.quantity);
  }
  for (const auto& first : responses.front()->elements) {
    CurveSet set;
    set.curves.quantity = first.is_stress ? "stress" : "force";
    set.curves.card = first.card;
    set.curves.ids = first.ids;
    set.forms = list_output_forms(first.components, first.is_stress);
    for (const auto& form : set.forms) set.curves.components.push_back(form.component);
    set.num_components = static_cast<Index>(first.components.size());
    const auto is_same = [&](const auto& other) {
      return other.card == first.card && other.ids == first.ids && other.components == first.components &&
             other.is_stress == first.is_stress;
    };
    if (find_others(responses, &records::ResponseSubcase::elements, 1, is_same, set))
      sets.push_back(std::move(set));
    else
      report((first.is_stress ? "stress of " : "force of ") + records::get_card_of_group(first.card));
  }
  return sets;
}

/// |F y|² of each form per frequency; factors: L of S = L Lᴴ per frequency.
MatrixXd calc_psd(const CurveSet& set, const std::vector<MatrixXcd>& factors) {
  const Index num_hz = set.real.front()->rows(), num_entities = set.real.front()->cols() / set.num_components;
  const auto num_forms = static_cast<Index>(set.forms.size());
  MatrixXd psd(num_hz, num_entities * num_forms);
  for (Index i = 0; i < num_hz; ++i) {
    const auto& L = factors[static_cast<std::size_t>(i)];
    MatrixXcd y = MatrixXcd::Zero(set.real.front()->cols(), L.cols());
    for (std::size_t j = 0; j < set.real.size(); ++j) {
      Eigen::VectorXcd response(y.rows());
      response.real() = set.real[j]->row(i).transpose();
      response.imag() = set.imag[j]->row(i).transpose();
      y += response * L.row(static_cast<Index>(j));
    }
    for (Index entity = 0; entity < num_entities; ++entity)
      for (Index f = 0; f < num_forms; ++f)
        psd(i, entity * num_forms + f) =
            (set.forms[static_cast<std::size_t>(f)].F * y.middleRows(entity * set.num_components, set.num_components))
                .squaredNorm();
  }
  return psd;
}

std::string name_column(const RandomCurves& curves, Index column) {
  const auto at = static_cast<std::size_t>(column);
  if (curves.card.empty())
    return curves.quantity + ":" + std::to_string(curves.dofs[at].first) + ":" + std::to_string(curves.dofs[at].second);
  const auto num = curves.components.size();
  return records::get_card_of_group(curves.card) + (curves.quantity == "stress" ? ":stress:" : ":") +
         std::to_string(curves.ids[at / num]) + ":" + curves.components[at % num];
}

/// Where the output frequencies are too few for the RMS.
void compare_rms(const records::RandomResponse& result, const SourceLocation& at, Diagnostics& diagnostics) {
  Index num = 0, num_off = 0;
  double worst = 0;
  std::string text;
  for (const auto& curves : result.curves) {
    const double largest = curves.modal_rms.size() > 0 ? curves.modal_rms.maxCoeff() : 0;
    for (Index c = 0; c < curves.modal_rms.size(); ++c) {
      const double rms = curves.rms(c), modal = curves.modal_rms(c);
      if (!(modal > kNoise * largest)) continue;
      ++num;
      const double difference = std::abs(rms - modal) / modal;
      if (difference <= kRmsWarning) continue;
      ++num_off;
      if (difference <= worst) continue;
      worst = difference;
      text = name_column(curves, c) + " has an RMS of " + to_text(rms) + " from the output frequencies, " +
             to_text(modal) + " from the integral over the band";
    }
  }
  if (num_off > 0)
    diagnostics.warning(
        "modal.random-sampling", at,
        text + "; " + std::to_string(num_off) + " of " + std::to_string(num) + " outputs differ by more than 1 %",
        "the output frequencies are too coarse for the bandwidth of the modes: add FREQ4 or FREQ3 cards");
}

/// The curves of this quantity of a subcase and the column of the component; nullptr: not among them.
const records::ResponseCurves* find_column(const records::ResponseSubcase& response,
                                           const records::RandomCross::Output& output, Index& column) {
  for (const auto& curves : response.curves) {
    if (curves.quantity != output.quantity) continue;
    for (std::size_t i = 0; i < curves.dofs.size(); ++i) {
      const auto& [id, component] = curves.dofs[i];
      if (id != output.id || std::max(component, 1) != output.component) continue;
      column = static_cast<Index>(i);
      return &curves;
    }
  }
  return nullptr;
}

/// A component of an element and the sign that Nastran gives it.
struct ItemCode {
  const char* name;
  double sign;
};

/// Component of an item code of RCROSS; nullptr: not known. Codes on which the tables of real and of complex results
/// agree (Quick Reference Guide, item codes). Moments of bars are those of the bending planes 1 (xy) and 2 (xz).
const ItemCode* find_item(const std::string& card, bool is_stress, int code) {
  static const std::map<std::string, std::vector<ItemCode>> forces{
      {"CBAR",
       {{"moment_z_a", 1},
        {"moment_y_a", -1},
        {"moment_z_b", 1},
        {"moment_y_b", -1},
        {"shear_y", 1},
        {"shear_z", 1},
        {"axial", 1},
        {"torque", 1}}},
      {"CBUSH", {{"force_x", 1}, {"force_y", 1}, {"force_z", 1}, {"moment_x", 1}, {"moment_y", 1}, {"moment_z", 1}}},
      {"CROD", {{"axial", 1}}},
      {"CONROD", {{"axial", 1}}},
      {"CTUBE", {{"axial", 1}}},
      {"CELAS1", {{"force", 1}}},
      {"CELAS2", {{"force", 1}}},
      {"CELAS3", {{"force", 1}}},
      {"CELAS4", {{"force", 1}}}};
  static const std::map<std::string, std::vector<ItemCode>> stresses{
      {"CROD", {{"xx", 1}}}, {"CONROD", {{"xx", 1}}}, {"CTUBE", {{"xx", 1}}}};
  const auto& table = is_stress ? stresses : forces;
  const auto found = table.find(card);
  constexpr int kFirst = 2;  // code 1 is the id
  if (found == table.end() || code < kFirst || code - kFirst >= static_cast<int>(found->second.size())) return nullptr;
  return &found->second[static_cast<std::size_t>(code - kFirst)];
}

/// Values of an element output over the frequencies; empty: not among the results.
Eigen::VectorXcd find_element_values(const records::ResponseSubcase& response,
                                     const records::RandomCross::Output& output) {
  for (const auto& curves : response.elements) {
    if (curves.is_stress != (output.quantity == "stress")) continue;
    const auto id = std::find(curves.ids.begin(), curves.ids.end(), output.id);
    if (id == curves.ids.end()) continue;
    const auto* item = find_item(records::get_card_of_group(curves.card), curves.is_stress, output.component);
    if (!item) continue;
    const auto name = std::find(curves.components.begin(), curves.components.end(), item->name);
    if (name == curves.components.end()) continue;
    const auto column = static_cast<Index>((id - curves.ids.begin()) * static_cast<long>(curves.components.size()) +
                                           (name - curves.components.begin()));
    Eigen::VectorXcd values(curves.real.rows());
    values.real() = item->sign * curves.real.col(column);
    values.imag() = item->sign * curves.imag.col(column);
    return values;
  }
  return {};
}

/// H_a L: the response of an output to each factor of S = L Lᴴ, frequencies x factors; empty: not requested.
MatrixXcd calc_driven(const Responses& responses, const std::vector<MatrixXcd>& factors,
                      const records::RandomCross::Output& output) {
  const bool is_of_element = output.quantity == "force" || output.quantity == "stress";
  MatrixXcd H(static_cast<Index>(factors.size()), static_cast<Index>(responses.size()));
  for (std::size_t j = 0; j < responses.size(); ++j) {
    if (is_of_element) {
      const auto values = find_element_values(*responses[j], output);
      if (values.size() == 0) return {};
      H.col(static_cast<Index>(j)) = values;
      continue;
    }
    Index column = 0;
    const auto* curves = find_column(*responses[j], output, column);
    if (!curves) return {};
    H.col(static_cast<Index>(j)).real() = curves->real.col(column);
    H.col(static_cast<Index>(j)).imag() = curves->imag.col(column);
  }
  MatrixXcd driven(H.rows(), factors.empty() ? 0 : factors.front().cols());
  for (Index i = 0; i < H.rows(); ++i) driven.row(i) = H.row(i) * factors[static_cast<std::size_t>(i)];
  return driven;
}

VectorXd list_lags(const records::DynamicDeck& deck, int set) {
  for (const auto& card : deck.dynamics.lags)
    if (card.sid == set) return VectorXd::LinSpaced(card.count + 1, card.first, card.last);
  return {};
}

}  // namespace

RandomAnalysis::RandomAnalysis(const records::DynamicDeck& deck, const std::vector<records::DynamicSubcase>& subcases,
                               Diagnostics& diagnostics)
    : deck_(deck) {
  for (const auto& subcase : subcases) {
    add_cross_set(subcase, diagnostics);
    const int set = subcase.dynamics.random;
    const bool is_known =
        std::any_of(inputs_.begin(), inputs_.end(), [set](const auto& input) { return input.first->set() == set; });
    if (set == 0 || is_known) continue;
    const auto at = deck.locate(subcase.find_command("RANDOM"));
    inputs_.emplace_back(std::make_unique<InputSpectrum>(deck, set, at, diagnostics), at);
  }
  const auto* param = deck.find_param("RMSINT");
  is_loglog_ = param && param->value == "LOGLOG";
}

void RandomAnalysis::add_cross_set(const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  const int set = subcase.dynamics.rcross;
  if (set == 0 || std::count(cross_sets_.begin(), cross_sets_.end(), set) > 0) return;
  cross_sets_.push_back(set);
  const auto at = deck_.locate(subcase.find_command("RCROSS"));
  const auto& cards = deck_.dynamics.crosses;
  if (std::none_of(cards.begin(), cards.end(), [set](const auto& card) { return card.sid == set; }))
    diagnostics.error("modal.missing-random", at,
                      "RCROSS = " + std::to_string(set) + " names no RCROSS card of the deck",
                      "add RCROSS with this id, or correct the id");
  if (subcase.dynamics.random == 0)
    diagnostics.error("modal.missing-random", at, "RCROSS without RANDOM has no spectral densities",
                      "select RANDPS by RANDOM in the same subcase");
}

void RandomAnalysis::add_crosses(const Responses& responses, const std::vector<MatrixXcd>& factors,
                                 records::RandomResponse& result, Diagnostics& diagnostics) const {
  static const std::map<std::string, std::string> quantities{{"DISP", "displacement"}, {"VELO", "velocity"},
                                                             {"ACCE", "acceleration"}, {"SPCF", "spc_force"},
                                                             {"FORCE", "force"},       {"STRESS", "stress"}};
  for (const auto& card : deck_.dynamics.crosses) {
    if (std::count(cross_sets_.begin(), cross_sets_.end(), card.sid) == 0) continue;
    records::RandomCross cross;
    std::string missing;
    const auto find = [&](const records::CrossRequest::Output& output, records::RandomCross::Output& found) {
      const auto quantity = quantities.find(output.quantity);
      found = {quantity == quantities.end() ? "" : quantity->second, output.id, output.component};
      MatrixXcd driven;
      if (!found.quantity.empty()) driven = calc_driven(responses, factors, found);
      if (driven.size() == 0)
        missing =
            output.quantity + " of " + std::to_string(output.id) + ", component " + std::to_string(output.component);
      return driven;
    };
    const MatrixXcd a = find(card.a, cross.a), b = find(card.b, cross.b);
    if (!missing.empty()) {
      diagnostics.warning("modal.random-cross", deck_.locate(card.at),
                          "RCROSS " + std::to_string(card.sid) + " is left out: " + missing +
                              " is no output of every subcase of RANDPS",
                          "request DISPLACEMENT, VELOCITY, ACCELERATION or SPCFORCES of the grid, FORCE or STRESS of "
                          "the element (item codes of CBAR, CBUSH, CROD, CELASi) above the subcases");
      continue;
    }
    cross.curve = card.curve;
    cross.psd = a.cwiseProduct(b.conjugate()).rowwise().sum();
    const VectorXd S_aa = a.rowwise().squaredNorm(), S_bb = b.rowwise().squaredNorm();
    const VectorXd product = S_aa.cwiseProduct(S_bb);
    cross.coherence = (product.array() > 0).select(cross.psd.cwiseAbs2().array() / product.array(), 0);
    cross.covariance = calc_moments(result.hz, cross.psd.real(), false).m0(0);
    if (result.lags.size() > 0) cross.correlation = calc_correlation(result.hz, cross.psd, result.lags);
    result.crosses.push_back(std::move(cross));
  }
}

std::vector<records::RandomResponse> RandomAnalysis::calc(const std::vector<records::ResponseSubcase>& responses,
                                                          const std::map<int, ModalSource>& sources,
                                                          Diagnostics& diagnostics) const {
  std::vector<records::RandomResponse> results;
  for (const auto& [input, at] : inputs_) {
    Responses chosen;
    std::string missing;
    for (const int id : input->subcases()) {
      const auto found = std::find_if(responses.begin(), responses.end(), [id](const auto& s) { return s.id == id; });
      if (found != responses.end())
        chosen.push_back(&*found);
      else
        missing += (missing.empty() ? "" : ", ") + std::to_string(id);
    }
    if (!missing.empty()) {
      diagnostics.warning("modal.random-subcase", at,
                          "RANDOM = " + std::to_string(input->set()) +
                              " is left out: RANDPS relates subcases without a response: " + missing,
                          "correct what fails in these subcases, or solve them too");
      continue;
    }
    results.push_back(calc_set(*input, chosen, sources, at, diagnostics));
  }
  return results;
}

records::RandomResponse RandomAnalysis::calc_set(const InputSpectrum& input, const Responses& responses,
                                                 const std::map<int, ModalSource>& sources, const SourceLocation& at,
                                                 Diagnostics& diagnostics) const {
  records::RandomResponse result;
  result.set = input.set();
  result.subcases = input.subcases();
  result.hz = responses.front()->x;
  result.lags = list_lags(deck_, result.set);
  result.is_loglog = is_loglog_;
  for (const auto* other : responses)
    if (other->x.size() != result.hz.size() || !other->x.isApprox(result.hz, 1e-12))
      throw InputError("modal.random-frequencies", at,
                       "RANDPS " + std::to_string(result.set) + ": subcases " + std::to_string(responses.front()->id) +
                           " and " + std::to_string(other->id) + " have different frequencies",
                       "select the same FREQUENCY in both");
  if (result.hz.size() < 2)
    throw InputError("modal.random-frequencies", at,
                     "RANDPS " + std::to_string(result.set) + ": subcase " + std::to_string(responses.front()->id) +
                         " has one frequency, " + to_text(result.hz(0)) +
                         " Hz, and RMS values are integrals over two or "
                         "more",
                     "add FREQ1 to FREQ4 cards with the id of FREQUENCY");
  Diagnostics own;
  input.check(result.hz, own);
  own.throw_if_errors();
  for (const auto& item : own.items()) diagnostics.add(item);

  std::vector<int> members;
  for (std::size_t j = 0; j < responses.size(); ++j) members.push_back(static_cast<int>(j));
  std::vector<MatrixXcd> factors;
  for (const double f : result.hz) factors.push_back(input.factor(f, members));
  std::optional<ModalIntegral> integral;
  std::vector<const ModalSource*> solved;
  for (const int id : result.subcases)
    if (const auto found = sources.find(id); found != sources.end()) solved.push_back(&found->second);
  if (solved.size() == result.subcases.size() && result.hz.size() > 1) try {
      integral.emplace(input, solved, result.hz(0), result.hz(result.hz.size() - 1));
      result.integral_error = integral->error();
    } catch (const ComputationError&) {
      diagnostics.warning("modal.random-unbounded", at,
                          "the random response is unbounded: a mode within the band of the frequencies has no damping",
                          "give damping (SDAMPING, PARAM,G, GE, dampers)");
    }
  for (auto& set : list_sets(responses, at, diagnostics)) {
    auto& curves = set.curves;
    curves.psd = calc_psd(set, factors);
    const auto moments = calc_moments(result.hz, curves.psd, is_loglog_);
    curves.rms = calc_roots(moments.m0);
    curves.crossing_hz = calc_crossings(moments);
    if (result.lags.size() > 0) curves.autocorrelation = calc_autocorrelation(result.hz, curves.psd, result.lags);
    if (integral) {
      auto modal = integral->calc_moments(set.maps, set.forms, set.num_components);
      if (modal.m0.size() == 0) modal.m0 = modal.m2 = VectorXd::Zero(curves.rms.size());
      curves.modal_rms = calc_roots(modal.m0);
      curves.modal_crossing_hz = calc_crossings(modal);
    }
    result.curves.push_back(std::move(curves));
  }
  add_crosses(responses, factors, result, diagnostics);
  compare_rms(result, at, diagnostics);
  return result;
}

}  // namespace bough::modal::response
