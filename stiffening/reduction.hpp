#pragma once
/// \file The stages of reduce(): one deck, one spec, one body. Internal.
#include <map>

#include "fe/statics/statics.hpp"
#include "stiffening/augment.hpp"
#include "stiffening/body_basis.hpp"
#include "stiffening/reduce.hpp"

namespace bough::stiffening {

/// The stages in order, each filling its part of the record.
class Reduction {
 public:
  Reduction(const records::Deck& deck, const records::BodySpec& spec, const ReduceOptions& options,
            Diagnostics& diagnostics)
      : deck_(deck), spec_(spec), options_(options), diagnostics_(diagnostics) {}

  records::FlexBody run();

 private:
  /// The body file, or the deck when there is none.
  SourceLocation where() const { return spec_.file.empty() ? deck_.locate({0, 0}) : SourceLocation{spec_.file, 0, 0}; }
  void report(const std::string& stage) const {
    if (options_.progress) options_.progress(stage);
  }
  void check_spec();
  void check_nodes(const fe::Model& model);
  void check_node(const fe::Model& model, int id, const std::string& what, const SourceLocation& at);
  fe::ModelOptions make_model_options() const;
  int choose_subcase() const;
  std::shared_ptr<const fe::Prestress> calc_prestress(const fe::ModelOptions& options);
  void set_preload(const fe::Model& model);
  void add_thermal_stiffness(const fe::Model& model, std::size_t load, MatrixXd& K_G) const;
  void set_rigid_part(const fe::Model& model);
  std::vector<int> choose_columns(int available, const std::string& whose);
  void check_rigid(const fe::Model& model, const modal::bases::Basis& basis);
  void set_modes(const fe::System& system, const modal::bases::StaticSolve& solve);
  void set_given_modes(const fe::System& system);
  void set_damping(const fe::Model& model, const modal::bases::Basis& basis);
  void add_dampers(const fe::Model& model);
  void check_modal_matrices(const fe::Model& model);
  void set_nodes(const fe::Model& model);
  void set_integrals(const fe::Model& model);  ///< and effective masses, F_I
  std::map<std::pair<std::string, std::vector<std::string>>, std::vector<int>> choose_recovered(const fe::Model& model);
  void set_strain_energy(const fe::Model& model);
  void set_recovery(const fe::Model& model, const MatrixXd& U, const MatrixXd& F, const std::vector<int>& inertial);
  void set_stiffening(const fe::Model& model, const modal::bases::StaticSolve& solve);
  void make_loads(const fe::Model& model);
  /// Moves without turning: a grid of solids or rods alone. What a frame takes off its rows is no rotation of it.
  static bool lacks_rotation(const fe::Model& model, const fe::Node& node);
  void demand_effect(const fe::Model& model, const std::string& name, const Eigen::VectorXd& F);
  void report_partial_rotation(const fe::Model& model);
  void set_resultants(const fe::Model& model, const MatrixXd& F_ext);
  std::vector<int> choose_support(const fe::Model& model);
  bool is_on_dependent_node(const fe::Model& model) const;
  modal::bases::StaticSolve make_solver(const fe::System& system);
  fe::Model build_model();
  /// The model with the masses of [[body.augment]]; empty without.
  std::unique_ptr<const Augmented> augment(const fe::Model& model) const;
  /// Mass, mean axes and, by `orthogonalize`, modes of the body itself in the space of its augmented modes.
  void take_off_augmentation(const fe::Model& model, modal::bases::Basis& basis) const;
  void add_mechanism_error(const fe::Model& model, const std::string& what);

  bool is_free() const { return spec_.frame != records::BodyFrame::Fixed; }

  const records::Deck& deck_;
  const records::BodySpec& spec_;
  const ReduceOptions& options_;
  Diagnostics& diagnostics_;
  records::FlexBody body_;
  MatrixXd Phi_;
  modal::bases::ModesCheck modes_check_;
  fe::ModelOptions model_options_;  ///< that the model was built with
  std::vector<BodyLoad> loads_;
  const fe::SymmetricFactor* factor_ = nullptr;  // of K, kept by the static solver
};

}  // namespace bough::stiffening
