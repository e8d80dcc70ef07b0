#include "modal/response/random/input_spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>

#include "modal/response/function_table.hpp"
#include "modal/response/random/number_text.hpp"

namespace bough::modal::response {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXd;

/// Negative eigenvalues of S up to this share of its trace are round-off.
constexpr double kIndefinite = 1e-8;

/// Turbulence of unit length scale: S = 2 WG² L/U (1 + 2 (p + 1) x²)/(1 + x²)^(p + 3/2), x = k ω L/U.
double calc_gust(const records::GustSpectrum& gust, double hz) {
  const double p = gust.is_dryden ? 0.5 : 1.0 / 3, k = gust.is_dryden ? 1 : 1.339;
  const double x = k * 2 * std::numbers::pi * hz * gust.length_over_speed;
  return 2 * gust.rms * gust.rms * gust.length_over_speed * (1 + 2 * (p + 1) * x * x) / std::pow(1 + x * x, p + 1.5);
}

template <class Record>
const Record* find_id(const std::vector<Record>& all, int id) {
  const auto found = std::find_if(all.begin(), all.end(), [id](const auto& record) { return record.id == id; });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

void add_corners(const records::DynamicTable& table, std::vector<double>& corners) {
  for (const auto& [x, _] : table.points)
    corners.push_back(table.kind == 2 ? x + table.x1 : table.kind == 3 ? x * table.x2 + table.x1 : x);
}

InputSpectrum::InputSpectrum(const records::DynamicDeck& deck, int set, const SourceLocation& at,
                             Diagnostics& diagnostics)
    : deck_(deck), set_(set) {
  for (const auto& card : deck.dynamics.spectral_terms) {
    if (card.sid != set) continue;
    for (const int id : {card.j, card.k}) subcases_.push_back(id);
  }
  std::sort(subcases_.begin(), subcases_.end());
  subcases_.erase(std::unique(subcases_.begin(), subcases_.end()), subcases_.end());
  if (subcases_.empty())
    diagnostics.error("modal.missing-random", at,
                      "RANDOM = " + std::to_string(set) + " names no RANDPS card of the deck",
                      "add RANDPS with this id, or correct the id");
  for (const auto& card : deck.dynamics.spectral_terms)
    if (card.sid == set) add_term(card, diagnostics);
  check_subcases(diagnostics);
}

void InputSpectrum::add_term(const records::SpectralTerm& card, Diagnostics& diagnostics) {
  Term term;
  term.card = &card;
  const auto find_row = [&](int id) {
    return static_cast<int>(std::lower_bound(subcases_.begin(), subcases_.end(), id) - subcases_.begin());
  };
  term.row = find_row(card.j);
  term.column = find_row(card.k);
  if (card.table != 0) {
    term.table = find_id(deck_.dynamics.spectra, card.table);
    if (!term.table) term.gust = find_id(deck_.dynamics.gust_spectra, card.table);
    if (!term.table && !term.gust) {
      diagnostics.error("modal.missing-table", deck_.locate(card.at),
                        "RANDPS " + to_text(card.sid) + " names table " + to_text(card.table) +
                            ", which no TABRND1 or TABRNDG card of the deck has",
                        "add the table or correct the id");
      return;
    }
  }
  if (card.j == card.k && card.x != 0 && term.table)
    for (const auto& [hz, value] : term.table->points)
      if (value < 0) {
        diagnostics.error("modal.bad-spectrum", deck_.locate(card.at),
                          "RANDPS " + to_text(card.sid) + ": the auto-spectral density of subcase " + to_text(card.j) +
                              " is negative: TABRND1 " + to_text(card.table) + " has " + to_text(value) + " at " +
                              to_text(hz) + " Hz",
                          "give values of zero or above");
        break;
      }
  terms_.push_back(term);
}

void InputSpectrum::check_subcases(Diagnostics& diagnostics) const {
  for (const int id : subcases_) {
    const auto card = std::find_if(terms_.begin(), terms_.end(),
                                   [&](const auto& term) { return term.card->j == id || term.card->k == id; });
    if (card == terms_.end()) continue;
    // A deck without SUBCASE is subcase 1.
    const auto subcase = std::find_if(deck_.subcases.begin(), deck_.subcases.end(),
                                      [&](const auto& s) { return std::max(s.id, 1) == id; });
    const auto selection =
        subcase == deck_.subcases.end() ? deck_.selections.end() : deck_.selections.find(subcase->id);
    if (subcase == deck_.subcases.end())
      diagnostics.error(
          "modal.random-subcase", deck_.locate(card->card->at),
          "RANDPS " + to_text(set_) + " names subcase " + to_text(id) + ", which the case control does not have",
          "correct J or K, or add the SUBCASE");
    else if (selection == deck_.selections.end() || selection->second.dload == 0)
      diagnostics.error("modal.random-subcase", deck_.locate(card->card->at),
                        "RANDPS " + to_text(set_) + " names subcase " + to_text(id) + ", which selects no DLOAD",
                        "write DLOAD = n in the subcase");
  }
}

double InputSpectrum::calc_table(const Term& term, double hz) {
  if (term.gust) return calc_gust(*term.gust, hz);
  return term.table ? evaluate(*term.table, hz) : 1;
}

MatrixXcd InputSpectrum::calc(double hz) const {
  const auto n = static_cast<Index>(subcases_.size());
  MatrixXcd S = MatrixXcd::Zero(n, n);
  for (const auto& term : terms_) {
    const auto value = std::complex<double>(term.card->x, term.card->y) * calc_table(term, hz);
    S(term.row, term.column) += value;
    if (term.row != term.column) S(term.column, term.row) += std::conj(value);
  }
  return S;
}

MatrixXcd InputSpectrum::factor(double hz, const std::vector<int>& members) const {
  const MatrixXcd S = calc(hz)(members, members);
  if (S.rows() == 1) return S.cwiseAbs().cwiseSqrt().cast<std::complex<double>>();
  const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(S);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

std::vector<std::vector<int>> InputSpectrum::list_groups() const {
  std::vector<int> group(subcases_.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<int>(i);
  for (const auto& term : terms_) {
    const int from = group[static_cast<std::size_t>(term.row)], to = group[static_cast<std::size_t>(term.column)];
    std::replace(group.begin(), group.end(), std::max(from, to), std::min(from, to));
  }
  std::vector<std::vector<int>> groups(group.size());
  for (std::size_t i = 0; i < group.size(); ++i)
    groups[static_cast<std::size_t>(group[i])].push_back(static_cast<int>(i));
  std::erase_if(groups, [](const auto& members) { return members.empty(); });
  return groups;
}

std::vector<double> InputSpectrum::list_corners() const {
  std::vector<double> corners;
  for (const auto& term : terms_)
    if (term.table) add_corners(*term.table, corners);
  return corners;
}

void InputSpectrum::check(const VectorXd& hz, Diagnostics& diagnostics) const {
  for (const auto& term : terms_) {
    if (!term.table || hz.size() == 0) continue;
    const double first = term.table->points.front().first, last = term.table->points.back().first;
    const double slack = 1e-9 * last;
    if (hz(0) >= first - slack && hz(hz.size() - 1) <= last + slack) continue;
    diagnostics.warning("modal.random-range", deck_.locate(term.card->at),
                        "RANDPS " + to_text(set_) + ": TABRND1 " + to_text(term.card->table) + " is given from " +
                            to_text(first) + " to " + to_text(last) + " Hz, the frequencies go from " + to_text(hz(0)) +
                            " to " + to_text(hz(hz.size() - 1)) + " Hz",
                        term.table->is_flat
                            ? "beyond its ends the table keeps its end values; give it points there"
                            : "beyond its ends the table goes on along its last line; give it points there");
  }
  for (const double f : hz) {
    const MatrixXcd S = calc(f);
    for (std::size_t j = 0; j < subcases_.size(); ++j) {
      const double value = S(static_cast<Index>(j), static_cast<Index>(j)).real();
      if (value >= 0) continue;
      const auto term = std::find_if(terms_.begin(), terms_.end(), [&](const auto& t) {
        return t.row == t.column && t.row == static_cast<int>(j) && t.card->x * calc_table(t, f) < 0;
      });
      diagnostics.error("modal.bad-spectrum",
                        deck_.locate(term == terms_.end() ? terms_.front().card->at : term->card->at),
                        "RANDPS " + to_text(set_) + ": the auto-spectral density of subcase " + to_text(subcases_[j]) +
                            " is " + to_text(value) + " at " + to_text(f) + " Hz",
                        "the table goes on along its last line there; give it points of zero or above");
      return;
    }
    const Eigen::SelfAdjointEigenSolver<MatrixXcd> solver(S, Eigen::EigenvaluesOnly);
    if (S.rows() < 2 || solver.eigenvalues()(0) >= -kIndefinite * S.diagonal().real().sum()) continue;
    const auto calc_excess = [&](const Term& term) {
      if (term.row == term.column) return -1.0;
      return std::norm(S(term.row, term.column)) - S(term.row, term.row).real() * S(term.column, term.column).real();
    };
    const auto cross = std::max_element(terms_.begin(), terms_.end(),
                                        [&](const Term& a, const Term& b) { return calc_excess(a) < calc_excess(b); });
    const auto& term = cross == terms_.end() ? terms_.front() : *cross;
    diagnostics.error(
        "modal.bad-spectrum", deck_.locate(term.card->at),
        "RANDPS " + to_text(set_) + ": at " + to_text(f) +
            " Hz the matrix of the spectral densities is not positive semi-definite (smallest eigenvalue " +
            to_text(solver.eigenvalues()(0)) + "): subcases " + to_text(term.card->j) + " and " +
            to_text(term.card->k) + " have |S_jk|² = " + to_text(std::norm(S(term.row, term.column))) +
            " and S_jj S_kk = " + to_text(S(term.row, term.row).real() * S(term.column, term.column).real()),
        "a coherence is at most 1: reduce the cross terms, or add the auto terms");
    return;
  }
}

}  // namespace bough::modal::response
