#pragma once
/// \file --f06 and --op2: results in Nastran's order and axes, as the output requests of the case control say.
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "analysis/listing/element_columns.hpp"
#include "analysis/listing/stress_columns.hpp"
#include "fe/model/model.hpp"
#include "formats/records/deck_dynamics.hpp"
#include "formats/records/listing.hpp"
#include "formats/records/static_result.hpp"
#include "modal/eigen.hpp"

namespace bough::analysis {

/// Requests of the case control of a deck, read on the first rank. Reports deck.combination. Collective.
records::CaseRequests read_requests_once(const std::string& path, Diagnostics& diagnostics);
/// Requests of a subcase; a deck without SUBCASE has one. nullptr: none.
const records::DynamicSelection* find_selection(const records::CaseRequests& requests, int subcase);
/// A subcase or combination wants some of what this command gives.
bool asks_for(const records::CaseRequests& requests, const std::string& command);
/// Notes cli.request-by-option for each of `options`, command of the case control and what gives it here, that some
/// subcase asks for.
void note_requests(const records::Deck& deck, const records::CaseRequests& requests,
                   const std::vector<std::pair<std::string, std::string>>& options, Diagnostics& diagnostics);
/// read_deck_or_throw with the cards of loads over frequency and time (nastran/dynamic_reader.hpp). `is_response`:
/// false for residual vectors of normal modes; `is_complex`: for complex modes. Collective.
records::DynamicDeck read_loads_deck_or_throw(const std::string& path, const fe::ModelOptions& options,
                                              bool is_response, Diagnostics& diagnostics, bool is_complex = false);

/// Collects what is listed, subcase after subcase. A deck without any output request is listed as a whole.
class ListingMaker {
 public:
  /// Reports cli.listing-default, cli.missing-set.
  ListingMaker(const records::Deck& deck, const records::CaseRequests& requests, Diagnostics& diagnostics);

  /// About the grid of PARAM,GRDPNT, else about the origin; not with a negative one. Once.
  void add_weight(const fe::Model& model);
  /// `pairs` in their order of the record, residual vectors last; masses of modes: φᵀMφ. Collective.
  void add_modes(const fe::Model& model, const modal::EigenPairs& pairs, int num_residual, Diagnostics& diagnostics);
  /// Adds load factors and shapes of a buckling subcase, with the forces and stresses of its shapes. Generalized
  /// stiffness φᵀKφ, generalized mass φᵀKφ / λ. Collective.
  void add_buckling(const fe::Model& model, const modal::EigenPairs& pairs, int subcase, Diagnostics& diagnostics);
  /// Adds the results of a static subcase as its output requests select them: displacements, loads, constraint forces,
  /// elements.
  void add_static(const fe::Model& model, const records::StaticSubcase& solved, Diagnostics& diagnostics);

  /// Returns the listing of all steps added so far.
  const records::Listing& get() const { return listing_; }
  /// Grid of MEFFMASS(GRID = ...) of a subcase; 0: the origin; no value if it is not requested.
  std::optional<int> find_effective_mass_grid(int subcase) const;

 private:
  /// Ids requested by a command of the case control.
  struct Choice {
    const records::CaseSet* set = nullptr;  ///< nullptr: all
    bool is_printed = true;
    bool is_fibre = false;  ///< STRAIN(FIBER)
    /// Returns true if the request includes the grid or element `id`; a request without a set includes all.
    bool contains(int id) const { return set == nullptr || set->contains(id); }
  };
  std::optional<Choice> choose(int subcase, const std::string& command) const;
  records::ListedStep make_step(int subcase) const;
  void add_vector(const fe::Model& model, const std::string& command, records::ListedKind kind,
                  const Eigen::Ref<const Eigen::VectorXd>& u_g, records::ListedStep& step) const;
  /// Notes once what a block would have listed.
  void note_unlisted(const std::string& what, Diagnostics& diagnostics);
  void add_elements(const fe::Model& model, const ElementIndex& elements,
                    const std::vector<records::ElementForces>& forces, const BeamLoads& loads,
                    records::ListedStep& step, Diagnostics& diagnostics);
  /// Beam loads of a subcase, or of the sum for a combination.
  BeamLoads sum_beam_loads(const fe::Model& model, const records::StaticSubcase& solved) const;
  void add_stresses(const fe::Model& model, const ElementIndex& elements,
                    const std::vector<records::ElementStresses>& stresses,
                    const std::vector<records::ElementForces>& forces, records::ListedStep& step,
                    Diagnostics& diagnostics);
  /// Stresses or strains of CBUSH by the recovery coefficients of their PBUSH. \param u_g  displacements of the
  /// strains.
  void add_bushes(const ElementIndex& elements, const std::vector<records::ElementForces>& forces,
                  const Eigen::Ref<const Eigen::VectorXd>& u_g, records::ListedStep& step) const;
  /// Grid point stresses of the SURFACEs and VOLUMEs that GPSTRESS and STRFIELD select.
  void add_grid_stresses(const fe::Model& model, const ElementIndex& elements,
                         const std::vector<records::ElementForces>& forces, records::ListedStep& step,
                         Diagnostics& diagnostics);
  /// Strains, only if the deck requests them.
  void add_strains(const fe::Model& model, const ElementIndex& elements,
                   const std::vector<records::ElementStresses>& strains,
                   const std::vector<records::ElementForces>& forces, records::ListedStep& step,
                   Diagnostics& diagnostics);
  /// Only if the deck requests them.
  void add_energies(const std::vector<records::ElementForces>& elements, double total, records::ListedStep& step) const;
  void add_grid_forces(const fe::Model& model, const std::vector<records::GridForce>& forces,
                       records::ListedStep& step) const;
  /// A step of vectors, forces, stresses and energies for each column of `Phi`. `reactions`: of shape j; empty: none.
  void add_shapes(const fe::Model& model, const modal::EigenPairs& pairs, const records::ListedRoots& roots,
                  const std::function<Eigen::VectorXd(Eigen::Index)>& reactions, Diagnostics& diagnostics);
  void report_sets(Diagnostics& diagnostics) const;

  const records::Deck& deck_;
  const records::CaseRequests& requests_;
  bool lists_all_ = true;
  std::map<int, StressLimits> limits_;
  std::set<std::string> left_out_;  ///< forces and stresses of cli.unlisted-elements
  records::Listing listing_;
};

}  // namespace bough::analysis
