#include "modal/response/deck_response.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <type_traits>

#include "fe/statics/build_model.hpp"
#include "fe/statics/statics.hpp"
#include "formats/records/params.hpp"
#include "formats/records/selection.hpp"
#include "modal/null_motions.hpp"
#include "modal/response/accuracy.hpp"
#include "modal/response/frequency_tables.hpp"
#include "modal/response/load_steps.hpp"
#include "modal/response/residual_modes.hpp"
#include "modal/response/rotor_response.hpp"
#include "modal/tolerances.hpp"

namespace bough::modal::response {
namespace {

/// Steps at corners of loads: each has a separate matrix exponential.
constexpr int kMaxCorners = 2000, kMaxCoupled = 50;
/// Solved directly: each has two separate factorizations.
constexpr int kMaxFactored = 20;
/// Springs with tables that get residual vectors.
constexpr Eigen::Index kMaxTableVectors = 60;

double to_hz(double lambda) { return std::sqrt(std::max(lambda, 0.0)) / (2 * std::numbers::pi); }

}  // namespace

ModeBasis calc_mode_basis(const fe::System& system, const EigenOptions& options, const records::DynamicDeck& deck,
                          int& num_massless, Diagnostics& diagnostics) {
  EigenPairs low;
  const double lowest = std::max(options.min_hz.value_or(0), records::get_real_param(deck, "LFREQ", 0, diagnostics));
  EigenOptions chosen_options = options;
  ModeBasis basis;
  if (options.min_hz && *options.min_hz > 0) {
    EigenOptions below = options;
    below.num_modes = 0;
    below.min_hz.reset();
    below.max_hz = options.min_hz;
    Diagnostics unsaid;
    low = calc_normal_modes(system, below, unsaid);
  } else {
    chosen_options.min_hz.reset();
  }
  const auto pairs = calc_normal_modes(system, chosen_options, diagnostics);
  num_massless = std::max(pairs.num_massless, low.num_massless);
  const auto num_low = low.lambda.size();
  std::vector<int> kept;
  const double highest = records::get_real_param(deck, "HFREQ", 1e30, diagnostics);
  const double max_modes = records::get_real_param(deck, "LMODES", 0, diagnostics);
  for (int j = 0; j < pairs.lambda.size(); ++j) {
    // A root at V1 itself is in both.
    if (num_low > 0 && pairs.lambda(j) <= low.lambda(num_low - 1) * (1 + detail::kSameEigenvalue)) continue;
    if (to_hz(pairs.lambda(j)) > highest || (max_modes > 0 && static_cast<double>(kept.size()) >= max_modes)) break;
    kept.push_back(j);
  }
  const auto num = num_low + static_cast<Eigen::Index>(kept.size());
  basis.lambda.resize(num);
  basis.Phi.resize(system.model.num_gdofs(), num);
  if (num_low > 0) basis.lambda.head(num_low) = low.lambda;
  if (num_low > 0) basis.Phi.leftCols(num_low) = low.Phi;
  basis.lambda.tail(num - num_low) = pairs.lambda(kept);
  basis.Phi.rightCols(num - num_low) = pairs.Phi(Eigen::all, kept);
  basis.num_rigid = num_low > 0 ? low.num_rigid : std::min<int>(pairs.num_rigid, static_cast<int>(num));
  basis.num_left_out = static_cast<int>(num_low);
  while (basis.num_left_out < num && lowest > 0 && to_hz(basis.lambda(basis.num_left_out)) < lowest)
    ++basis.num_left_out;
  return basis;
}

std::unique_ptr<fe::StaticSolver> make_residual_solver(const fe::System& system, const ModeBasis& modes,
                                                       int num_massless) {
  std::vector<int> supports;
  if (modes.num_rigid > 0 || num_massless > 0) {
    const auto motions = detail::find_null_motions(detail::Pencil(system));
    supports = motions.held;
    supports.insert(supports.end(), motions.supports.begin(), motions.supports.end());
    std::sort(supports.begin(), supports.end());
    supports.erase(std::unique(supports.begin(), supports.end()), supports.end());
  }
  return std::make_unique<fe::StaticSolver>(system.model, system.K, std::move(supports));
}

namespace {

/// K2PP X; a symmetric matrix (IFO 6) gives each term once.
MatrixXd times_direct(const fe::Model& model, const records::DynamicDeck& deck,
                      const std::vector<std::pair<double, std::string>>& names, MatrixXd X) {
  MatrixXd Y = MatrixXd::Zero(X.rows(), X.cols());
  Diagnostics unsaid;  // the model has reported what is wrong
  for (Eigen::Index c = 0; c < X.cols(); ++c) turn_to_cd(model, X.col(c));
  for (const auto& [scale, name] : names)
    for (const auto& matrix : deck.direct_matrices) {
      if (matrix.name != name) continue;
      for (const auto& e : matrix.entries) {
        const int i = find_dof(model, deck, e.gi, e.ci, name, matrix.at, unsaid);
        const int j = find_dof(model, deck, e.gj, e.cj, name, matrix.at, unsaid);
        if (i < 0 || j < 0) continue;
        Y.row(i) += scale * e.value * X.row(j);
        if (matrix.form == 6 && i != j) Y.row(j) += scale * e.value * X.row(i);
      }
    }
  for (Eigen::Index c = 0; c < Y.cols(); ++c) turn_to_basic(model, Y.col(c));
  return Y;
}

/// K2PP, M2PP and B2PP are taken with K2GG, M2GG and B2GG: where these mean more, it is an error.
void check_direct_input(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                        Diagnostics& diagnostics) {
  const auto& d = subcase.dynamics;
  const auto demand = [&](bool is_wrong, const char* command, const char* why) {
    if (is_wrong)
      diagnostics.error("modal.direct-input", deck.locate(subcase.find_command(command)),
                        std::string(command) + " is taken as part of the model, on which " + why + " acts too",
                        std::string("write ") + command[0] + "2GG if it should, or leave " + why + " out");
  };
  const auto is_scaled = [&](const char* param) { return records::get_real_param(deck, param, 1, diagnostics) != 1; };
  demand(!d.k2pp.empty() && is_scaled("CK2"), "K2PP", "PARAM,CK2");
  demand(!d.m2pp.empty() && is_scaled("CM2"), "M2PP", "PARAM,CM2");
  demand(!d.b2pp.empty() && is_scaled("CB2"), "B2PP", "PARAM,CB2");
  demand(!d.m2pp.empty() && records::get_real_param(deck, "ALPHA1", 0, diagnostics) != 0, "M2PP", "PARAM,ALPHA1");
  demand(!d.m2pp.empty() &&
             (!deck.gravity.empty() || !deck.load_cards.rotations.empty() || !deck.special.accelerations.empty()),
         "M2PP", "a load by GRAV, RFORCE or ACCEL");
}

/// PARAM,ENFMOTN or ENFMETH is REL; the default of MSC Nastran is ABS.
bool is_relative(const records::Deck& deck) {
  const auto is_rel = [&](const char* name) {
    const auto* param = deck.find_param(name);
    return param && param->value == "REL";
  };
  return is_rel("ENFMOTN") || is_rel("ENFMETH");
}

}  // namespace

DampingChoice choose_damping(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                             const ResponseOptions& options, const fe::Model& model, Diagnostics& diagnostics) {
  const bool is_over_time = options.is_over_time;
  DampingChoice damping;
  damping.is_over_time = is_over_time;
  damping.g = records::get_real_param(deck, "G", 0, diagnostics);
  damping.w3 = records::get_real_param(deck, "W3", 0, diagnostics);
  damping.w4 = records::get_real_param(deck, "W4", 0, diagnostics);
  damping.alpha1 = records::get_real_param(deck, "ALPHA1", 0, diagnostics);
  damping.alpha2 = records::get_real_param(deck, "ALPHA2", 0, diagnostics);
  if (!subcase.dynamics.k2pp.empty())
    damping.times_direct = [&model, &deck, names = subcase.dynamics.k2pp](const MatrixXd& X) {
      return times_direct(model, deck, names, X);
    };
  check_direct_input(deck, subcase, diagnostics);
  damping.is_stiffness = records::get_real_param(deck, "KDAMP", 1, diagnostics) < 0;
  const int set = subcase.dynamics.sdamping;
  const auto& curves = deck.dynamics.damping;
  const auto curve = std::find_if(curves.begin(), curves.end(), [set](const auto& c) { return c.id == set; });
  if (curve != curves.end()) damping.curve = &*curve;
  damping.is_relative = is_relative(deck);
  if (set != 0 && !damping.curve && !options.is_direct)  // a direct solution has no modes to damp
    diagnostics.error("modal.missing-table", deck.locate(subcase.find_command("SDAMPING")),
                      "SDAMPING = " + std::to_string(set) + " names no TABDMP1 card of the deck",
                      "add the table or correct the id");
  if (!is_over_time) return damping;
  const auto& elements = model.elements();
  const bool has_ge = std::any_of(elements.begin(), elements.end(),
                                  [](const auto& element) { return element->structural_damping() != 0; });
  const bool lacks_w3 = damping.g != 0 && damping.w3 <= 0, lacks_w4 = has_ge && damping.w4 <= 0;
  if (lacks_w3 || lacks_w4)
    diagnostics.note("modal.no-w3", deck.locate({}),
                     std::string(lacks_w3 ? "PARAM,G" : "GE of the materials") +
                         (lacks_w3 && lacks_w4 ? " and GE" : "") + " does not act over time without PARAM," +
                         (lacks_w3 ? "W3" : "W4") + ", as in Nastran",
                     "give the circular frequency at which structural damping is to be viscous");
  return damping;
}

namespace {

/// Rotors of RGYRO that the response supports; none without RGYRO.
std::optional<rotors::RotorCase> choose_supported_rotors(const fe::Model& model, const records::DynamicDeck& deck,
                                                         const records::DynamicSubcase& subcase,
                                                         const ResponseOptions& options, Diagnostics& diagnostics) {
  auto rotor_case = rotors::choose_rotors(model, deck, subcase, rotors::RotorUse::Frequency, diagnostics);
  if (!rotor_case) return rotor_case;
  const auto at = deck.locate(subcase.find_command("RGYRO"));
  if (options.is_over_time)
    diagnostics.error("modal.rotor-unsupported", at, "RGYRO is not supported over time",
                      "compute the frequency response, the complex modes, or the run of a system with the rotor");
  if (options.with_random && !options.is_direct)
    diagnostics.error("modal.rotor-unsupported", at,
                      "RANDOM by modes is not supported with rotors: its modal integrals have no gyroscopic terms",
                      "solve directly (SOL 108, --direct)");
  diagnostics.throw_if_errors();
  return rotor_case;
}

/// nullptr without RGYRO.
std::shared_ptr<const RotorResponse> make_rotors(const fe::Model& model, const records::DynamicDeck& deck,
                                                 const records::DynamicSubcase& subcase, const ResponseOptions& options,
                                                 double g, const std::vector<OutputChoice>& outputs,
                                                 Diagnostics& diagnostics) {
  const auto rotor_case = choose_supported_rotors(model, deck, subcase, options, diagnostics);
  if (!rotor_case) return nullptr;
  const auto at = deck.locate(subcase.find_command("RGYRO"));
  const auto is_fixed = [&](int grid) {
    const auto& node = model.node(model.find_node(grid));
    return std::any_of(model.fixed_dofs().begin(), model.fixed_dofs().end(),
                       [&](int dof) { return dof >= node.first_gdof && dof < node.first_gdof + 6; });
  };
  for (const auto& output : outputs)
    for (const auto& axis : rotor_case->axes)
      for (const int grid : axis.grids)
        if (output.quantity == "spc_force" && !diagnostics.has("modal.rotor-reaction") && is_fixed(grid) &&
            std::find(output.ids.begin(), output.ids.end(), grid) != output.ids.end())
          diagnostics.warning("modal.rotor-reaction", at,
                              "the SPC force at grid " + std::to_string(grid) + " of rotor " + std::to_string(axis.id) +
                                  " has no gyroscopic and no circulatory part",
                              "support the rotor by springs to other grids, and fix those");
  return std::make_shared<RotorResponse>(model, *rotor_case, g, diagnostics);
}

/// Terms of rotors and of tables over frequency; empty without both.
AddedStiffness join_terms(const std::shared_ptr<const RotorResponse>& rotors,
                          const std::shared_ptr<const FrequencyTables>& tables) {
  if (!rotors && !tables) return {};
  return [&rotors, &tables](double hz) -> linear::ComplexSparse {
    if (!rotors) return tables->calc_matrix(hz);
    linear::ComplexSparse Z = rotors->calc_stiffness(hz);
    if (tables) Z += tables->calc_matrix(hz);
    return Z;
  };
}

/// Tables of PELAST, PDAMPT and PBUSHT; nullptr without, and over time, where the values of the properties count.
std::shared_ptr<const FrequencyTables> make_tables(const fe::Model& model, const records::DynamicDeck& deck,
                                                   const ResponseOptions& options, double g, Diagnostics& diagnostics) {
  if (!options.is_over_time) report_part_tables(deck, diagnostics);
  auto tables = std::make_shared<FrequencyTables>(model, deck, g, diagnostics);
  diagnostics.throw_if_errors();
  if (tables->is_empty()) return nullptr;
  const auto at = deck.locate(deck.dynamics.frequency_tables.front().at);
  if (options.is_over_time) {
    diagnostics.note("modal.nominal-tables", at,
                     "tables over frequency have no effect over time: the values of PELAS, PDAMP and PBUSH count",
                     "compute the frequency response for the tables");
    return nullptr;
  }
  if (!options.is_direct)
    diagnostics.note("modal.nominal-tables", at,
                     "the modes are those of the values of PELAS and PBUSH; at each frequency the difference of the "
                     "tables is added in the space of the modes and residual vectors",
                     "give values near those of the tables at the frequencies of interest, or solve directly");
  return tables;
}

/// Φᵀ Z Φ and Φᵀ Z Ψ.
AddedCoordinates project(const AddedStiffness& added, const ResponseModel& response) {
  if (!added) return {};
  return [&added, &response](double hz) {
    const auto Z = added(hz);
    const MatrixXcd Phi = response.Phi.cast<std::complex<double>>(), Psi = response.Psi.cast<std::complex<double>>();
    const MatrixXcd ZPhi = Z * Phi, ZPsi = Z * Psi;
    return std::pair<MatrixXcd, MatrixXcd>(Phi.transpose() * ZPhi, Phi.transpose() * ZPsi);
  };
}

/// Reports inputs that a solution without modes does not use.
void report_modal(const records::DynamicDeck& deck, const records::DynamicSubcase& subcase, bool is_over_time,
                  Diagnostics& diagnostics) {
  if (subcase.dynamics.sdamping != 0)
    diagnostics.warning("modal.no-modes", deck.locate(subcase.find_command("SDAMPING")),
                        "SDAMPING damps modes: the direct solution leaves it out, as in Nastran",
                        "damp by PARAM,G, GE or dampers, or solve by modes (--modal)");
  if (subcase.dynamics.modsel != 0)
    diagnostics.warning("modal.no-modes", deck.locate(subcase.find_command("MODSEL")),
                        "MODSEL selects modes: the direct solution has none and leaves it out",
                        "solve by modes (--modal), or take it out");
  if (is_over_time) return;
  const int set = subcase.dynamics.frequency;
  for (const auto& list : deck.dynamics.frequencies)
    if (list.sid == set && list.kind >= 3)
      diagnostics.error("modal.no-modes", deck.locate(subcase.find_command("FREQUENCY")),
                        "FREQUENCY = " + std::to_string(set) + " has a FREQ" + std::to_string(list.kind) +
                            " card, which lies about natural frequencies: a direct solution finds none",
                        "give FREQ, FREQ1 or FREQ2, or solve by modes (--modal)");
}

}  // namespace

void check_rotors(const fe::Model& model, const records::DynamicDeck& deck, const records::DynamicSubcase& subcase,
                  const ResponseOptions& options, Diagnostics& diagnostics) {
  if (const auto rotor_case = choose_supported_rotors(model, deck, subcase, options, diagnostics))
    fe::find_rotors(model, rotor_case->axes, diagnostics);
}

std::vector<records::DynamicSubcase> choose_response_subcases(const records::DynamicDeck& deck, int requested,
                                                              bool is_over_time) {
  std::vector<records::DynamicSubcase> chosen;
  for (const auto& subcase : deck.subcases) {
    const auto selection = deck.selections.find(subcase.id);
    const bool has_load = selection != deck.selections.end() &&
                          (selection->second.dload != 0 || (is_over_time && selection->second.ic != 0));
    if (requested != 0 ? subcase.id == requested : has_load)
      chosen.emplace_back(subcase,
                          selection != deck.selections.end() ? selection->second : records::DynamicSelection{});
  }
  if (!chosen.empty() || requested != 0) return chosen;
  throw InputError("modal.no-dynamic-load", deck.locate({}),
                   std::string("no subcase selects a DLOAD") + (is_over_time ? " or IC" : ""),
                   "write DLOAD = n in the case control, with RLOAD or TLOAD cards");
}

/// Model and matrices that do not depend on the loads.
struct DeckResponseSolver::Prepared {
  Prepared(fe::Model&& built) : model(std::move(built)), system(model) {}
  const fe::Model model;
  const fe::System system;
  ModeBasis modes;
  std::unique_ptr<fe::StaticSolver> statics;

  void find_modes(const EigenOptions& options, const records::DynamicDeck& deck, Diagnostics& diagnostics) {
    int num_massless = 0;
    modes = calc_mode_basis(system, options, deck, num_massless, diagnostics);
    statics = make_residual_solver(system, modes, num_massless);
  }
};

struct DeckResponseSolver::Task {
  Excitation excitation;
  StartMotion start;
  DampingChoice damping;
  TimeGrid grid;  ///< over time
  VectorXd hz;    ///< over frequency
  VectorXd natural;
  std::vector<OutputChoice> outputs;
  std::shared_ptr<const RotorResponse> rotors;    ///< nullptr without
  std::shared_ptr<const FrequencyTables> tables;  ///< nullptr without
};

DeckResponseSolver::DeckResponseSolver(const records::DynamicDeck& deck, fe::ModelOptions model_options,
                                       ResponseOptions options)
    : deck_(deck), model_options_(std::move(model_options)), options_(std::move(options)) {}
DeckResponseSolver::~DeckResponseSolver() = default;

void DeckResponseSolver::prepare(const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  const std::array<int, 7> held{subcase.spc,
                                subcase.mpc,
                                subcase.suport1,
                                subcase.preload,
                                subcase.method,
                                subcase.initial_temperature,
                                subcase.material_temperature};
  if (prepared_ && held_ == held) return;
  prepared_.reset();
  held_ = held;
  Diagnostics own;
  model_options_.subcase = subcase.id;
  model_options_.prestress = nullptr;
  if (options_.choose_prestress) model_options_.prestress = options_.choose_prestress(model_options_, subcase, own);
  auto prepared = std::make_unique<Prepared>(fe::build_model(deck_, model_options_, own));
  own.throw_if_errors();
  if (!options_.is_direct) prepared->find_modes(options_.choose_eigen(subcase, own), deck_, own);
  own.throw_if_errors();
  for (const auto& item : own.items()) diagnostics.add(item);
  prepared_ = std::move(prepared);
}

records::ResponseSubcase DeckResponseSolver::solve(const records::DynamicSubcase& subcase, Diagnostics& diagnostics) {
  prepare(subcase, diagnostics);
  const auto& model = prepared_->model;
  Diagnostics own;
  Task task;
  task.excitation = calc_excitation(model, deck_, subcase, options_.is_over_time, own);
  if (options_.is_over_time) task.start = calc_start(model, deck_, subcase, own);
  task.damping = choose_damping(deck_, subcase, options_, model, own);
  if (options_.is_over_time) task.grid = make_times(deck_, subcase, own);
  if (options_.is_direct) report_modal(deck_, subcase, options_.is_over_time, own);
  task.natural.resize(prepared_->modes.lambda.size());
  for (Eigen::Index j = 0; j < task.natural.size(); ++j) task.natural(j) = to_hz(prepared_->modes.lambda(j));
  if (options_.is_direct) own.throw_if_errors();
  if (!options_.is_over_time)
    task.hz =
        make_frequencies(deck_, subcase, task.natural.tail(task.natural.size() - prepared_->modes.num_left_out), own);
  own.throw_if_errors();
  task.outputs = choose_outputs(model, deck_, subcase, task.excitation, options_.grids, options_.with_listing, own);
  own.throw_if_errors();
  task.rotors = make_rotors(model, deck_, subcase, options_, task.damping.g, task.outputs, own);
  task.tables = make_tables(model, deck_, options_, task.damping.g, own);
  records::ResponseSubcase result;
  result.id = std::max(subcase.id, 1);  // what stands above all subcases is the first, as in Nastran
  result.title = subcase.title;
  result.subtitle = subcase.subtitle;
  result.label = subcase.label;
  result.is_direct = options_.is_direct;
  if (options_.is_direct)
    solve_directly(task, subcase, result, own);
  else
    solve_by_modes(task, subcase, result, own);
  for (const auto& item : own.items()) diagnostics.add(item);
  return result;
}

void DeckResponseSolver::solve_by_modes(const Task& task, const records::DynamicSubcase& subcase,
                                        records::ResponseSubcase& result, Diagnostics& diagnostics) {
  const auto& model = prepared_->model;
  const auto& [_, start, damping, grid, hz, natural, outputs, rotors, tables] = task;
  Excitation excitation = task.excitation;
  excitation.residual = collect_unit_loads(model, deck_, diagnostics).F;
  if (tables && tables->directions().cols() <= kMaxTableVectors) {
    MatrixXd all(model.num_gdofs(), excitation.residual.cols() + tables->directions().cols());
    all << excitation.residual, MatrixXd(tables->directions());
    excitation.residual = all;
  }
  diagnostics.throw_if_errors();
  if (damping.curve && excitation.D.cols() > 0) result.damped_motion = damping.is_relative ? "relative" : "absolute";
  const bool with_residuals = options_.residual_vectors.value_or(subcase.dynamics.resvec.value_or(
      deck_.find_param("RESVEC") == nullptr || deck_.find_param("RESVEC")->value[0] != 'N'));
  const auto solve_static = [&](const MatrixXd& F) { return prepared_->statics->solve(F, &diagnostics); };
  auto response = make_response_model(model, prepared_->modes, solve_static, excitation, start, damping, with_residuals,
                                      diagnostics);
  select_modes(deck_, subcase, prepared_->modes.num_left_out, response, diagnostics);
  diagnostics.throw_if_errors();
  result.num_rigid = response.num_rigid;
  result.mode_hz.resize(response.num_dynamic());
  for (Eigen::Index j = 0; j < response.num_dynamic(); ++j) {
    result.mode_hz(j) = to_hz(response.lambda(j));
    result.kind.push_back(j < response.num_normal ? records::ModeKind::Normal : records::ModeKind::Residual);
  }
  result.damping_ratio = response.damping_ratio.head(response.num_dynamic());
  if (options_.is_over_time) {
    const auto steps =
        refine_times(deck_, excitation, grid, response.is_coupled ? kMaxCoupled : kMaxCorners, diagnostics);
    const auto history = calc_history(response, excitation, steps);
    result.solution_error = history.step_error;
    recover(model, response, excitation, damping, outputs, history, result);
  } else {
    const double highest = natural.size() > 0 ? natural(natural.size() - 1) : 0;
    if (response.num_normal < model.num_fdofs() && hz(hz.size() - 1) > highest) {
      char text[112];
      std::snprintf(text, sizeof text, "the model is driven up to %.6g Hz, its modes end at %.6g Hz", hz(hz.size() - 1),
                    highest);
      diagnostics.warning("modal.response-range", deck_.locate(subcase.find_command("FREQUENCY")), text,
                          "take more modes: beyond them there are residual vectors only");
    }
    const auto added = join_terms(rotors, tables);
    const auto projected = project(added, response);
    const auto spectrum = calc_spectrum(response, excitation, hz, diagnostics, projected);
    result.solution_error = calc_solution_error(response, spectrum, projected);
    recover(model, response, excitation, damping, outputs, spectrum, tables.get(), result);
    if (options_.with_random && !tables)  // the integral by modes has poles of constant matrices
      sources_[result.id] =
          ModalSource(response, excitation, make_coordinate_maps(model, response, excitation, damping, outputs));
  }
  const auto basis_error = calc_basis_error(model, response);
  result.basis_error = basis_error.worst;
  report_accuracy(basis_error, result.solution_error, deck_.locate({}), diagnostics);
}

void DeckResponseSolver::solve_directly(const Task& task, const records::DynamicSubcase& subcase,
                                        records::ResponseSubcase& result, Diagnostics& diagnostics) const {
  const auto& model = prepared_->model;
  const auto& [excitation, start, damping, grid, hz, natural, outputs, rotors, tables] = task;
  const auto direct = make_direct_model(prepared_->system, deck_, subcase, excitation, damping);
  const auto take = [&, &e = excitation, &d = damping, &o = outputs, &t = tables](const auto& motion) {
    if constexpr (std::is_same_v<std::decay_t<decltype(motion)>, MotionBlock<MatrixXcd>>)
      recover(model, e, d, o, motion, t.get(), result);
    else
      recover(model, e, d, o, motion, result);
  };
  if (options_.is_over_time)
    result.solution_error = solve_history(model, direct, excitation, start,
                                          refine_times(deck_, excitation, grid, kMaxFactored, diagnostics), take);
  else
    result.solution_error =
        solve_spectrum(model, direct, excitation, hz, take, diagnostics, join_terms(rotors, tables));
  report_residual(result.solution_error, deck_.locate({}), diagnostics);
}

}  // namespace bough::modal::response
