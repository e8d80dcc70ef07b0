#pragma once
/// \file Content of a deck, body, system or HDF5 file, and every error in it.
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "analysis/common/events.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/system_files.hpp"
#include "fe/matrices/grid_point_weight.hpp"
#include "fe/model/model.hpp"
#include "fe/statics/superelement_check.hpp"
#include "formats/records/body_spec.hpp"

namespace bough::analysis {

struct CheckRequest {
  std::string file;                ///< deck, body.toml, system.toml, HDF5, flat body or .FLX
  std::vector<std::string> set;    ///< "name=value" of [parameters] of a system file
  ModelChoice model;               ///< of a deck
  std::optional<int> weight_grid;  ///< grid of the weight table, 0: the origin; none: PARAM,GRDPNT
};

/// Energies of the rigid-body motions on the three sets; a support strains the f-set, which is no fault.
struct GroundChecks {
  Eigen::Matrix<double, 6, 1> g, n, f;
};

/// A subcase that has a load, temperatures or enforced displacements.
struct SubcaseCheck {
  records::Subcase subcase;
  Eigen::Matrix<double, 6, 1> resultant = Eigen::Matrix<double, 6, 1>::Zero();  ///< [F, F L] about the origin
  int num_enforced = 0, num_heated = 0;
  bool is_resolved = false;  ///< its sets exist: the members above are known
};

/// A subcase of a response over frequency or time, by the SOL of the deck.
struct ResponseCheck {
  int subcase = 0;
  bool is_over_time = false;
  bool follows_modes = false;          ///< FREQ3 to FREQ5: the frequencies are known with the modes
  Eigen::Index num_steps = 0;          ///< frequencies or times
  double first = 0, last = 0;          ///< [Hz] or [T]
  int num_loads = 0, num_motions = 0;  ///< terms of its DLOAD: forces, and motions of supports
};

struct DeckCheck {
  records::Deck deck;
  std::optional<fe::Model> model;  ///< none if the cards have errors; the members below are set with it
  records::MassProperties mass;    ///< about the origin
  GroundChecks ground;
  std::vector<fe::SuperelementCheck> superelements;  ///< in the order of deck.superelements
  std::optional<fe::GridPointWeight> weight;
  std::vector<SubcaseCheck> subcases;
  std::vector<ResponseCheck> responses;
};

struct BodyCheck {
  records::BodySpec spec;
  std::optional<DeckCheck> deck;  ///< none for given matrices
};

struct SystemCheck {
  LoadedSystem loaded;
};

struct FlexBodyCheck {
  std::string name;
  int body_id = 0;  ///< of a .FLX
  double mass = 0;
  Eigen::VectorXd frequency_hz;
  int num_nodes = 0, num_kg_inertial = 0;
  std::size_t num_interface_nodes = 0, num_locators = 0;
  double kg_asymmetry = 0;  ///< largest of the geometric stiffness matrices, relative
  std::vector<int> large;   ///< third order: the large modes, from 0
  /// Second order with the energy of soft modes: the deflection in the first of them that is estimated to be off by
  /// run.linear-limit, and what third order costs.
  struct Reach {
    int mode = 0, node = 0;  ///< from 0; id of the node that moves most
    double deflection = 0;   ///< [L]
    int num_large = 0;       ///< of third order, at most
    /// More, the latter on a processor of 3 GHz with AVX2.
    double file_kilobytes = 0, evaluation_microseconds = 0;
  };
  std::optional<Reach> reach;
};
using FlxCheck = std::vector<FlexBodyCheck>;  ///< the bodies of a .FLX

struct ResultsCheck {
  Eigen::Index num_samples = 0;
  double start = 0, end = 0;  ///< [T]
  std::size_t num_channels = 0;
  bool completed = false;
  std::string reason;
};

struct ModesCheck {
  Eigen::Index num_modes = 0;
  std::size_t num_grids = 0;
  int num_rigid_modes = 0;
};

struct StaticCheck {
  struct Subcase {
    int id = 0;
    std::string load_set;
    std::vector<std::string> elements;  ///< names of the cards with forces
  };
  std::string num_dofs;
  std::vector<Subcase> subcases;
};

struct MatricesCheck {
  std::string num_dofs;
  std::vector<std::string> names;
};

struct LinearCheck {
  int num_states = 0, num_inputs = 0, num_outputs = 0;
  double time = 0, error = 0;
};

struct CheckAnswer {
  /// monostate: a file of another format, which is an error among the messages.
  std::variant<std::monostate, DeckCheck, BodyCheck, SystemCheck, FlexBodyCheck, FlxCheck, ResultsCheck, ModesCheck,
               StaticCheck, MatricesCheck, LinearCheck>
      content;
  Diagnostics messages;  ///< errors among them do not throw: one pass shows all
};

class CheckEvents : public Events {
 public:
  /// Called before a deck is read, on every rank.
  virtual void set_rank(int /*rank*/) {}
};

/// Inertia about the centre of mass: I_ref - m (|c|² 1 - c cᵀ), c from the reference. [M L^2] basic axes.
Eigen::Matrix3d calc_central_inertia(const records::MassProperties& properties);
/// Eigenvalues of the central inertia, ascending. [M L^2]
Eigen::Vector3d calc_principal_inertias(const records::MassProperties& properties);

/// Collective for decks and body files. Throws InputError only for what keeps the file from being read.
CheckAnswer check_file(const CheckRequest& request, CheckEvents& events);

}  // namespace bough::analysis
