// Commands as functions: reduce, modes, static, select. Those that take files of Bough are in commands.cpp.
#include "analysis/common/body_files.hpp"
#include "analysis/listing/listing_files.hpp"
#include "analysis/modes/modes.hpp"
#include "analysis/reduce/reduce_body.hpp"
#include "analysis/select/system_selection.hpp"
#include "analysis/static/case_extremes.hpp"
#include "analysis/static/static.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/nastran/loads_deck.hpp"
#include "python/bindings/requests.hpp"

namespace bough::python {

namespace {

py::tuple reduce(const std::string& file, std::optional<int> modes, std::optional<double> max_hz,
                 std::optional<std::vector<int>> interface, std::optional<bool> free, std::optional<bool> full,
                 std::optional<std::string> name, std::optional<std::string> mass, std::optional<std::string> integrals,
                 std::optional<std::vector<double>> origin, std::optional<double> damping, std::optional<int> subcase,
                 Strings loads, Strings recover, Strings ignore, Strings matrices, bool strain_energy,
                 const std::string& loads_deck, int loads_set, const std::string& solver, const py::object& progress) {
  if (modes && *modes < 0)
    throw py::value_error("modes is a number of modes, 0 or more, not " + std::to_string(*modes));
  if (max_hz && !(*max_hz > 0)) throw py::value_error("max_hz is a frequency above 0, not " + std::to_string(*max_hz));
  if (origin && origin->size() != 3) throw py::value_error("origin has three numbers");
  if (loads_set < 1 || loads_set > 99999988)
    throw py::value_error("loads_set is the first of twelve load sets, 1 to 99999988, not " +
                          std::to_string(loads_set));
  if (file.empty() && matrices.empty()) throw py::value_error("file is missing; only matrices do without");
  analysis::ReduceRequest request;
  request.file = file;
  request.name = name.value_or("");
  request.num_modes = modes;
  request.max_hz = max_hz;
  request.free = free.value_or(false);
  request.interface_nodes = interface.value_or(std::vector<int>{});
  request.loads = std::move(loads);
  request.full = full;
  request.strain_energy = strain_energy;
  request.recover = std::move(recover);
  request.mass = mass.value_or("");
  request.integrals = integrals.value_or("");
  request.origin = origin.value_or(std::vector<double>{});
  request.ignore_cards = std::move(ignore);
  request.subcase = subcase.value_or(0);
  request.damping = damping;
  request.matrices = std::move(matrices);
  request.solver = solver;
  records::FlexBody body;
  auto messages = run_request(file, progress, [&](PythonEvents& events) {
    announce_output(loads_deck);
    body = analysis::reduce_body(
               request, [](const records::BodySpec&) {}, events)
               .body;
    if (!loads_deck.empty()) write_output(loads_deck, nastran::write_loads_deck(body, loads_set));
  });
  return py::make_tuple(std::move(body), std::move(messages));
}

}  // namespace

analysis::ModelChoice make_model_choice(int subcase, bool free, const std::string& mass, Strings ignore) {
  if (mass != "deck" && mass != "lumped" && mass != "consistent")
    throw py::value_error("mass is deck, lumped or consistent, not " + mass);
  return {subcase, free, mass, std::move(ignore)};
}

namespace {

/// Keeps the modes of the first subcase.
class FirstModes final : public analysis::ModesReceiver {
 public:
  explicit FirstModes(std::string deck) : deck_(std::move(deck)) {}
  void begin(std::size_t, bool is_complex) override {
    if (is_complex)
      throw InputError("cli.complex-option", {deck_}, "the deck requests complex modes, bough.modes gives real ones",
                       "add ignore=\"CMETHOD\", or write a file by bough.call(\"modes\", deck, \"-o\", file)");
  }
  void take(analysis::SubcaseModes& modes, Diagnostics&) override {
    if (!result) result = std::move(modes.result);
  }
  void take(records::ComplexModesResult&, Diagnostics&) override {}

  std::optional<records::ModesResult> result;

 private:
  std::string deck_;
};

py::tuple modes(const std::string& deck, std::optional<int> number, std::optional<double> min_hz,
                std::optional<double> max_hz, bool buckling, bool no_check, const std::string& solver, bool energies,
                int meffmass, int subcase, bool free, const std::string& mass, Strings ignore, const std::string& f06,
                const std::string& op2, const py::object& progress) {
  const analysis::ListingFiles listing{f06, op2};
  if (buckling && !listing.empty()) throw py::value_error("f06 and op2 list normal modes, not load factors");
  if (number && *number < 1)
    throw py::value_error("number is a number of modes above 0, not " + std::to_string(*number));
  analysis::ModesRequest request;
  request.deck = deck;
  request.model = make_model_choice(subcase, free, mass, std::move(ignore));
  request.eigen = {number.value_or(0), min_hz, max_hz, buckling, no_check, solver};
  request.energies = energies;
  request.about_grid = meffmass;
  request.has_listing = !listing.empty();
  FirstModes found(deck);
  auto messages = run_request(deck, progress, [&](PythonEvents& events) {
    announce_outputs({f06, op2});
    const auto answer = analysis::solve_modes(request, found, events);
    if (!answer.failures.is_empty()) answer.failures.throw_all(events.get_messages());
    if (answer.listing) analysis::write_listings(listing, *answer.listing);
  });
  return py::make_tuple(std::move(*found.result), std::move(messages));
}

/// Keeps all subcases.
class StaticRecord final : public analysis::StaticReceiver {
 public:
  explicit StaticRecord(bool has_extremes) : has_extremes_(has_extremes) {}
  void begin(bool) override {}
  void set_model(const fe::Model& model) override {
    result.dof_map = model.calc_dof_map();
    result.mesh = model.calc_mesh();
  }
  void add(std::vector<records::StaticSubcase> subcases) override {
    for (auto& subcase : subcases) {
      if (has_extremes_) analysis::add_to_extremes(result.dof_map, subcase, result.extremes);
      result.subcases.push_back(std::move(subcase));
    }
  }
  const std::vector<records::StaticSubcase>& get_kept() override { return result.subcases; }

  records::StaticResult result;

 private:
  bool has_extremes_;
};

/// The bytes of the HDF5 file, and the messages.
py::tuple solve_static(const std::string& deck, int subcase, bool free, const std::string& mass, Strings ignore,
                       Strings grid_forces, bool linear, bool nonlinear, int increments, bool arc_length, bool strains,
                       bool extremes, const std::string& f06, const std::string& op2, const py::object& progress) {
  const analysis::ListingFiles listing{f06, op2};
  analysis::StaticRequest request;
  request.deck = deck;
  request.model = make_model_choice(subcase, free, mass, std::move(ignore));
  request.grid_forces = std::move(grid_forces);
  request.is_linear = linear;
  request.is_nonlinear = nonlinear;
  request.num_increments = increments;
  request.has_arc_length = arc_length;
  request.has_strains = strains;
  request.has_listing = !listing.empty();
  std::string image;
  auto messages = run_request(deck, progress, [&](PythonEvents& events) {
    announce_outputs({f06, op2});
    StaticRecord record(extremes);
    auto answer = analysis::solve_static(request, record, events);
    if (!answer.failures.is_empty()) answer.failures.throw_all(events.get_messages());
    record.result.source = std::move(answer.source);
    image = hdf5::make_static_image(record.result);
    if (answer.listing) analysis::write_listings(listing, *answer.listing);
  });
  return py::make_tuple(py::bytes(image), std::move(messages));
}

/// Appends the modes of a body to a ranking; `name`: of a body of a system.
void add_modes(const records::FlexBody& body, const std::string& name, const analysis::Selection& s, py::list& modes) {
  for (int i = 0; i < body.num_modes(); ++i) {
    const auto k = modes.size();
    const auto& mode = s.ranking.modes[k];
    py::dict one;
    put(one, "mode"_a = i + 1, "frequency_hz"_a = body.frequency_hz[i], "cost"_a = mode.cost,
        "share"_a = s.ranking.total > 0 ? mode.cost / s.ranking.total : 0, "closed_form"_a = mode.closed_form,
        "kept"_a = static_cast<bool>(s.choices[k].kept), "reason"_a = s.choices[k].reason);
    if (!name.empty()) one["body"] = name;
    if (s.modal_hankel.size() > 0) one["hankel"] = s.modal_hankel[i];
    if (body.effective_mass.rows() == body.num_modes()) {
      const Eigen::VectorXd row = body.effective_mass.row(i);
      one["effective_mass"] = std::vector<double>(row.begin(), row.end());
    }
    modes.append(one);
  }
}

/// Members as of `bough select --json`.
py::dict make_ranking(py::list modes, const analysis::Selection& s) {
  py::list losses;
  for (const auto& loss : s.losses) {
    py::dict one;
    put(one, "name"_a = loss.name, "total_cost"_a = loss.total, "lost_share"_a = loss.lost, "peak_gain"_a = loss.peak,
        "peak_error"_a = loss.error, "peak_error_hz"_a = loss.error_hz, "balanced_bound"_a = loss.balanced_bound,
        "steady_error"_a = loss.steady_error);
    losses.append(one);
  }
  py::dict ranking;
  put(ranking, "modes"_a = modes, "total_cost"_a = s.ranking.total, "other_cost"_a = s.ranking.other,
      "dropped_share"_a = s.dropped, "lost_share"_a = s.lost, "configurations"_a = losses);
  if (s.static_error >= 0) ranking["static_error"] = s.static_error;
  return ranking;
}

/// The smaller bodies by name, the ranking, the messages.
py::tuple select_system(const analysis::SelectRequest& request, const py::object& progress) {
  analysis::SystemSelection answer;
  analysis::SelectedFiles files;
  auto messages = run_request(request.systems.front(), progress, [&](PythonEvents& events) {
    analysis::list_select_inputs(request);
    answer = analysis::select_system_modes(request, events);
    files = analysis::make_selected_files(request, answer, ".");
  });
  py::dict small;
  py::list modes, bodies;
  for (std::size_t i = 0; i < answer.bodies.size(); ++i) {
    const auto& one = answer.bodies[i];
    add_modes(one.body, one.name, answer.selection, modes);
    auto kept = answer.list_kept(i);
    for (int& mode : kept) ++mode;
    py::dict about;
    put(about, "name"_a = one.name, "file"_a = one.file, "modes"_a = one.body.num_modes(), "kept"_a = kept);
    bodies.append(about);
    small[py::str(one.name)] = std::move(files.bodies[i].body);
  }
  auto ranking = make_ranking(std::move(modes), answer.selection);
  ranking["bodies"] = bodies;
  return py::make_tuple(std::move(small), std::move(ranking), std::move(messages));
}

/// The smaller body, the ranking, the messages. `body`: instead of the file; without both the bodies of the systems.
py::tuple select(const std::string& file, const records::FlexBody* body, Strings systems, Strings inputs,
                 Strings outputs, Strings weight, const std::string& spectrum, int number,
                 std::optional<double> tolerance, double below, Strings keep, double damping, std::vector<double> at,
                 bool equilibrium, bool open, bool exchange, Strings set, const py::object& progress) {
  analysis::SelectRequest request;
  request.body = file;
  request.systems = std::move(systems);
  request.set = std::move(set);
  request.inputs = std::move(inputs);
  request.outputs = std::move(outputs);
  request.weights = std::move(weight);
  request.spectrum = spectrum;
  request.pinned = std::move(keep);
  request.number = number;
  request.tolerance = tolerance;
  request.below_hz = below;
  request.damping = damping;
  request.at = std::move(at);
  request.equilibrium = equilibrium;
  request.open = open;
  request.exchange = exchange;
  if (body == nullptr && file.empty()) return select_system(request, progress);
  records::FlexBody small;
  records::FlexBody of_file;
  analysis::Selection selection;
  auto messages = run_request(file, progress, [&](PythonEvents& events) {
    Strings files;
    if (body == nullptr) {
      files = analysis::list_select_inputs(request);
      Diagnostics notes;
      of_file = analysis::read_moving_body(file, notes);
      analysis::add_messages(notes, events);
    } else if (!spectrum.empty()) {
      files = {spectrum};
    }
    const auto& whole = body == nullptr ? of_file : *body;
    selection = analysis::select_modes(request, whole, events);
    small = analysis::keep_selected(request, whole, selection, files);
  });
  py::list modes;
  add_modes(body == nullptr ? of_file : *body, "", selection, modes);
  auto ranking = make_ranking(std::move(modes), selection);
  return py::make_tuple(std::move(small), std::move(ranking), std::move(messages));
}

}  // namespace

void bind_analyses(py::module_& m) {
  const auto none = py::none();
  m.def("reduce", &reduce, py::arg("file") = "", py::kw_only(), py::arg("modes") = none, py::arg("max_hz") = none,
        py::arg("interface") = none, py::arg("free") = none, py::arg("full") = none, py::arg("name") = none,
        py::arg("mass") = none, py::arg("integrals") = none, py::arg("origin") = none, py::arg("damping") = none,
        py::arg("subcase") = none, py::arg("loads") = Strings(), py::arg("recover") = Strings(),
        py::arg("ignore") = Strings(), py::arg("matrices") = Strings(), py::arg("strain_energy") = false,
        py::arg("loads_deck") = "", py::arg("loads_set") = nastran::kFirstInertialSet, py::arg("solver") = "",
        py::arg("progress") = none);
  m.def("modes", &modes, py::arg("deck"), py::arg("number") = none, py::kw_only(), py::arg("min_hz") = none,
        py::arg("max_hz") = none, py::arg("buckling") = false, py::arg("no_check") = false, py::arg("solver") = "",
        py::arg("energies") = false, py::arg("meffmass") = 0, py::arg("subcase") = 0, py::arg("free") = false,
        py::arg("mass") = "deck", py::arg("ignore") = Strings(), py::arg("f06") = "", py::arg("op2") = "",
        py::arg("progress") = none);
  m.def("static", &solve_static, py::arg("deck"), py::kw_only(), py::arg("subcase") = 0, py::arg("free") = false,
        py::arg("mass") = "deck", py::arg("ignore") = Strings(), py::arg("grid_forces") = Strings(),
        py::arg("linear") = false, py::arg("nonlinear") = false, py::arg("increments") = 10,
        py::arg("arc_length") = false, py::arg("strains") = false, py::arg("extremes") = false, py::arg("f06") = "",
        py::arg("op2") = "", py::arg("progress") = none, "The bytes of the file of bough static.");
  m.def("select", &select, py::arg("file"), py::arg("body"), py::kw_only(), py::arg("systems") = Strings(),
        py::arg("inputs") = Strings(), py::arg("outputs") = Strings(), py::arg("weight") = Strings(),
        py::arg("spectrum") = "", py::arg("number") = 0, py::arg("tolerance") = none, py::arg("below") = 0.0,
        py::arg("keep") = Strings(), py::arg("damping") = 0.01, py::arg("at") = std::vector<double>(),
        py::arg("equilibrium") = false, py::arg("open") = false, py::arg("exchange") = false,
        py::arg("set") = Strings(), py::arg("progress") = none,
        "The body with the modes kept, and what bough select --json prints.");
}

}  // namespace bough::python
