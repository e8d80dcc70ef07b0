// Commands as functions whose records are dicts: check, compare, edit, info, export, plot, report, flx, integrals,
// convert, run, batch, response, equilibrium.
#include <atomic>

#include "analysis/campaign/campaign.hpp"
#include "analysis/check/check.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/compare/compare.hpp"
#include "analysis/convert/convert.hpp"
#include "analysis/edit/edit_session.hpp"
#include "analysis/equilibrium/equilibrium.hpp"
#include "analysis/export/export.hpp"
#include "analysis/flx/flx.hpp"
#include "analysis/info/info.hpp"
#include "analysis/integrals/integrals.hpp"
#include "analysis/plot/plot.hpp"
#include "analysis/report/report.hpp"
#include "analysis/response/budget.hpp"
#include "analysis/response/response.hpp"
#include "analysis/run/run.hpp"
#include "cli/verbs.hpp"
#include "python/bindings/plot_style.hpp"
#include "python/bindings/requests.hpp"
#include "report/svg_plot.hpp"

namespace bough::python {

namespace {

/// An array with a copy of the numbers.
template <class Matrix>
py::array copy(const Eigen::MatrixBase<Matrix>& values) {
  return give(typename Matrix::PlainObject(values));
}

py::dict make_mass(const records::MassProperties& p) {
  py::dict mass;
  put(mass, "mass"_a = p.mass, "cg"_a = copy(p.cg), "inertia"_a = copy(p.inertia));
  return mass;
}

py::list make_events(const std::vector<records::EventRecord>& events) {
  py::list list;
  for (const auto& event : events) {
    py::dict one;
    put(one, "time"_a = event.time, "what"_a = event.what, "source"_a = event.source);
    list.append(one);
  }
  return list;
}

/// \name Content of a file that `check` read, each with its kind.
///@{
void describe(const std::monostate&, py::dict& d) { d["kind"] = py::none(); }
void describe(const analysis::DeckCheck& check, py::dict& d) {
  d["kind"] = "deck";
  d["sol"] = check.deck.sol;
  py::dict cards, skipped;
  for (const auto& [name, count] : check.deck.card_counts) cards[py::str(name)] = count;
  for (const auto& card : check.deck.unused) skipped[py::str(card.name)] = card.count;
  d["cards"] = cards;
  d["skipped"] = skipped;
  if (!check.model) return;
  put(d, "num_nodes"_a = check.model->nodes().size(), "num_elements"_a = check.model->elements().size(),
      "num_dofs"_a = check.model->num_gdofs(), "num_free_dofs"_a = check.model->num_fdofs(),
      "mass_properties"_a = make_mass(check.mass), "ground_check"_a = copy(check.ground.g),
      "ground_check_n"_a = copy(check.ground.n), "ground_check_f"_a = copy(check.ground.f));
  py::list autospc, subcases;
  for (const auto& entry : check.model->autospc()) autospc.append(py::make_tuple(entry.node, entry.component));
  for (const auto& row : check.subcases) {
    py::dict one;
    put(one, "id"_a = row.subcase.id, "load_set"_a = row.subcase.load,
        "resultant"_a = row.is_resolved ? py::object(copy(row.resultant)) : py::none(),
        "num_enforced"_a = row.num_enforced, "num_heated"_a = row.num_heated);
    subcases.append(one);
  }
  d["autospc"] = autospc;
  d["subcases"] = subcases;
}
void describe(const analysis::BodyCheck& check, py::dict& d) {
  if (check.deck) describe(*check.deck, d);
  put(d, "kind"_a = "body", "name"_a = check.spec.name, "deck"_a = check.spec.deck);
}
void describe(const analysis::SystemCheck& check, py::dict& d) {
  d["kind"] = "system";
  const auto& system = check.loaded.system;
  py::list bodies;
  for (int b = 0; b < system.num_bodies(); ++b) {
    py::dict one;
    put(one, "name"_a = system.body_name(b), "hinge"_a = system.hinge_name(b),
        "num_hinge_dofs"_a = system.num_hinge_u(b), "num_modes"_a = system.num_modes(b));
    bodies.append(one);
  }
  d["bodies"] = bodies;
  d["num_speeds"] = system.num_dofs();
}
void describe(const analysis::FlexBodyCheck& check, py::dict& d) {
  put(d, "kind"_a = "bough-flexbody", "name"_a = check.name, "mass"_a = check.mass,
      "frequency_hz"_a = copy(check.frequency_hz), "num_nodes"_a = check.num_nodes,
      "num_interface_nodes"_a = check.num_interface_nodes, "num_locators"_a = check.num_locators,
      "kg_asymmetry"_a = check.kg_asymmetry);
}
void describe(const analysis::FlxCheck& check, py::dict& d) {
  d["kind"] = "flx";
  py::list bodies;
  for (const auto& body : check) {
    py::dict one;
    describe(body, one);
    one["body_id"] = body.body_id;
    bodies.append(one);
  }
  d["bodies"] = bodies;
}
void describe(const analysis::ResultsCheck& check, py::dict& d) {
  put(d, "kind"_a = "bough-results", "num_samples"_a = check.num_samples, "start"_a = check.start, "end"_a = check.end,
      "num_channels"_a = check.num_channels, "completed"_a = check.completed, "reason"_a = check.reason);
}
void describe(const analysis::ModesCheck& check, py::dict& d) {
  put(d, "kind"_a = "bough-modes", "num_modes"_a = check.num_modes, "num_rigid_modes"_a = check.num_rigid_modes,
      "num_grids"_a = check.num_grids);
}
void describe(const analysis::StaticCheck& check, py::dict& d) {
  d["kind"] = "bough-static";
  py::list subcases;
  for (const auto& subcase : check.subcases) {
    py::dict one;
    put(one, "id"_a = subcase.id, "load_set"_a = subcase.load_set, "elements"_a = subcase.elements);
    subcases.append(one);
  }
  d["subcases"] = subcases;
}
void describe(const analysis::MatricesCheck& check, py::dict& d) {
  d["kind"] = "bough-matrices";
  d["names"] = check.names;
}
void describe(const analysis::LinearCheck& check, py::dict& d) {
  put(d, "kind"_a = "bough-linear", "num_states"_a = check.num_states, "num_inputs"_a = check.num_inputs,
      "num_outputs"_a = check.num_outputs, "time"_a = check.time, "error"_a = check.error);
}
///@}

/// The content, and every message, errors too.
py::tuple check(const std::string& file, Strings set, int subcase, bool free, const std::string& mass, Strings ignore) {
  struct CheckEvents final : PythonEventsOf<analysis::CheckEvents> {
    using PythonEventsOf::PythonEventsOf;
  };
  analysis::CheckRequest request;
  request.file = file;
  request.set = std::move(set);
  request.model = make_model_choice(subcase, free, mass, std::move(ignore));
  analysis::CheckAnswer answer;
  const py::object none = py::none();
  CheckEvents events(none);
  try {
    run_exclusive(file, [&] { answer = analysis::check_file(request, events); });
  } catch (const InputError& failure) {
    // Errors in the file are findings; those of the call, as a file that is not there, are raised.
    if (failure.items().empty() || failure.items().front().id.starts_with("cli.")) throw;
    for (const auto& item : failure.items()) answer.messages.add(item);
  }
  py::dict d;
  std::visit([&](const auto& content) { describe(content, d); }, answer.content);
  return py::make_tuple(d, answer.messages.items());
}

/// Arrays and lists of words by path, as in the file of `compare -o`.
py::dict make_comparison_dict(records::Comparison comparison) {
  py::dict d;
  const auto get_name = [](const std::string& path) { return py::str(path.starts_with('/') ? path.substr(1) : path); };
  for (auto& array : comparison.arrays) {
    if (array.values.cols() == 1)
      d[get_name(array.path)] = give(Eigen::VectorXd(array.values.col(0)));
    else
      d[get_name(array.path)] = give(std::move(array.values));
  }
  for (const auto& [path, words] : comparison.words) d[get_name(path)] = words;
  return d;
}

/// The integrals of one body by method.
py::dict compare_body(const records::FlexBody& body) {
  records::Comparison comparison;
  run_exclusive(body.name, [&] { comparison = analysis::make_comparison({}, analysis::check_integrals(body)); });
  return make_comparison_dict(std::move(comparison));
}

py::tuple compare(Strings files, const std::string& mass, bool refinement, const std::string& test,
                  const std::string& deck, const std::string& tam, int sensors, const py::object& progress) {
  if (test.empty() && (tam != "serep" || !deck.empty())) throw py::value_error("tam and deck go with test");
  if (tam != "serep" && deck.empty()) throw py::value_error("tam " + tam + " needs the deck of the model: deck=");
  if (!test.empty() && sensors > 0) throw py::value_error("test and sensors are two comparisons: leave out one");
  analysis::CompareRequest request{std::move(files), mass, refinement, test, deck, tam, sensors};
  records::Comparison comparison;
  auto messages = run_request(request.files.empty() ? "" : request.files.front(), progress, [&](PythonEvents& events) {
    comparison = analysis::make_comparison(request, analysis::compare_files(request, events));
  });
  return py::make_tuple(make_comparison_dict(std::move(comparison)), std::move(messages));
}

/// Keeps what the commands print; the commands of the program that a session offers are functions in Python.
class PythonEdit final : public analysis::EditHost {
 public:
  void print_data(const std::string& text) override { printed += text; }
  void print(const std::string&) override {}
  void print(const Diagnostics& diagnostics) override {
    for (const auto& item : diagnostics.items()) messages.add(item);
  }
  void check_output(const std::string& path) override { announce_output(path); }
  int run_command(const Strings& words) override {
    throw InputError("cli.edit-command", {}, "'" + words.front() + "' is a command of the program",
                     "call bough." + words.front() + " with the saved file");
  }

  std::string printed;
  Diagnostics messages;
};

/// Text after the commands, text that they printed, whether the text has changed, and the messages.
py::tuple edit(const std::string& file, const Strings& commands, const std::string& output) {
  PythonEdit host;
  std::string text;
  bool is_changed = false;
  run_exclusive(file, [&] {
    if (!output.empty()) announce_output(output);
    auto start = analysis::read_edit_text(file, host);
    const auto before = start.get_text();
    analysis::EditSession session(std::move(start), host, {}, output);
    for (std::size_t i = 0; i < commands.size(); ++i)
      if (!session.execute(commands[i], "<commands>", static_cast<int>(i) + 1)) break;
    if (!output.empty()) session.execute("save");
    text = session.get_text();
    is_changed = text != before;
  });
  return py::make_tuple(text, host.printed, is_changed, tell(host.messages));
}

py::dict info(const std::string& file) {
  analysis::InfoAnswer answer;
  run_exclusive(file, [&] { answer = analysis::list_contents(file); });
  py::dict d, attributes;
  for (const auto& [name, value] : answer.info.attributes) attributes[py::str(name)] = value;
  py::list objects;
  for (const auto& object : answer.info.objects) {
    py::dict one;
    put(one, "path"_a = object.path, "shape"_a = object.shape, "type"_a = object.type,
        "description"_a = object.description, "dims"_a = object.dims);
    objects.append(one);
  }
  put(d, "attributes"_a = attributes, "objects"_a = objects, "events"_a = make_events(answer.events),
      "faults"_a = answer.faults);
  return d;
}

/// The bytes of the file, or what there is to say of the files that were written, and the messages.
py::tuple export_file(const std::string& file, const std::string& to, const std::string& output, Strings channels,
                      bool ascii, bool moving, const std::string& fields, Strings ignore, int every,
                      std::vector<double> window, double scale, const std::string& follow, Strings bodies, Strings set,
                      const std::string& units, int fmi, int id, const std::string& inertia,
                      const std::string& ge_order, int digits, int unit, const std::string& vendor, int first_point) {
  demand_word("inertia", inertia, {"6x1", "3x3"});
  demand_word("ge_order", ge_order, {"mode", "component"});
  demand_word("vendor", vendor, {"nx", "msc"});
  if (digits < 6 || digits > 17) throw py::value_error("digits is 6 to 17, not " + std::to_string(digits));
  if (unit < 0 || first_point < 0) throw py::value_error("unit and first_point are numbers above 0, or 0: chosen");
  analysis::ExportRequest request{.file = file,
                                  .output = output,
                                  .format = to,
                                  .channels = channels,
                                  .is_ascii = ascii,
                                  .is_moving = moving,
                                  .fields = fields,
                                  .ignore_cards = std::move(ignore)};
  request.moving = {every, std::move(window), scale, follow, std::move(bodies)};
  request.fmu = {fmi, std::move(channels), std::move(set), units};
  request.component = {id, unit, vendor, first_point};
  request.body = {inertia, ge_order, digits};
  if (analysis::is_written_format(to) && output.empty()) throw py::value_error("export to " + to + " needs an output");
  analysis::ExportAnswer answer;
  auto messages = run_request(file, py::none(), [&](PythonEvents& events) {
    announce_output(output);
    answer = analysis::export_file(request, events);
    if (!analysis::is_written_format(to)) write_output(output, answer.text);
  });
  return py::make_tuple(py::bytes(answer.text), answer.num_frames, std::move(messages));
}

/// (curves of each plot, SVG, CSV), and the messages.
py::tuple plot(Strings files, Strings sensors, Strings labels, Strings points, const std::string& title,
               const std::string& x_label, const std::string& y_label, const std::string& kind, const std::string& x,
               bool psd, bool spectrum, bool difference, bool subplots, const std::string& srs,
               const std::string& output, Strings inputs, Strings outputs, int per_rev, std::vector<double> window,
               int segment, const std::string& srs_part, std::vector<double> srs_range, double q, bool log_x,
               bool log_y, std::optional<double> y_min, std::optional<double> y_max) {
  analysis::PlotRequest request;
  request.files = std::move(files);
  request.sensors = std::move(sensors);
  request.labels = std::move(labels);
  request.points = std::move(points);
  request.title = title;
  request.x_label = x_label;
  request.y_label = y_label;
  request.has_csv = true;
  request.linear.kind = kind;
  request.curves.x = x;
  request.curves.psd = psd;
  request.curves.spectrum = spectrum;
  request.curves.difference = difference;
  request.curves.subplots = subplots;
  request.curves.srs = srs;
  set_style({std::move(inputs), std::move(outputs), per_rev, std::move(window), segment, srs_part, std::move(srs_range),
             q, log_x, log_y, y_min, y_max},
            request);
  analysis::PlotAnswer answer;
  std::string svg;
  auto messages =
      run_request(request.files.empty() ? "" : request.files.front(), py::none(), [&](PythonEvents& events) {
        announce_output(output);
        answer = analysis::make_plots(request, events);
        svg = answer.plots.size() == 1 ? report::draw_svg(answer.plots.front()) : report::draw_svg(answer.plots);
        write_output(output, svg);
      });
  py::list plots;
  for (const auto& one : answer.plots) {
    py::list curves;
    for (const auto& curve : one.curves) {
      py::dict c;
      put(c, "label"_a = curve.label, "x"_a = copy(curve.x), "y"_a = copy(curve.y));
      curves.append(c);
    }
    py::dict p;
    put(p, "title"_a = one.title, "x_label"_a = one.x_label, "y_label"_a = one.y_label, "curves"_a = curves);
    plots.append(p);
  }
  return py::make_tuple(plots, svg, answer.csv, std::move(messages));
}

py::tuple make_report(Strings files, const std::string& output, Strings channels, const std::string& title,
                      const py::object& progress) {
  analysis::ReportRequest request{std::move(files), std::move(channels), title};
  std::string page;
  auto messages = run_request(request.files.empty() ? "" : request.files.front(), progress, [&](PythonEvents& events) {
    announce_output(output);
    page = analysis::make_report(request, events);
    write_output(output, page);
  });
  return py::make_tuple(page, std::move(messages));
}

py::dict make_flx_dict(const flx::FlxFile& file) {
  py::dict d;
  put(d, "body_id"_a = file.body_id, "name"_a = file.name, "method"_a = file.method, "mass"_a = file.mass,
      "modes"_a = file.modes, "M"_a = copy(file.M), "K"_a = copy(file.K), "D"_a = copy(file.D),
      "alpha"_a = copy(file.alpha), "integrals"_a = file.integrals, "node_id"_a = file.node_id,
      "node_xyz"_a = copy(file.node_xyz));
  py::list gains;
  for (const auto& gain : file.gains) gains.append(copy(gain));
  d["gains"] = gains;
  return d;
}

/// The text of the .FLX file and a dict for each body.
py::tuple make_flx(Strings bodies, const std::string& output, std::vector<int> body_ids, const std::string& integrals,
                   int modopt, int digits, bool special_nodes, bool stiffening) {
  analysis::FlxRequest request{std::move(bodies), std::move(body_ids), integrals, modopt, digits,
                               special_nodes,     stiffening};
  std::vector<flx::FlxFile> files;
  std::string text;
  run_request(request.bodies.empty() ? "" : request.bodies.front(), py::none(), [&](PythonEvents& events) {
    announce_output(output);
    Diagnostics diagnostics;
    files = analysis::make_flx_files(request, diagnostics);
    analysis::add_messages(diagnostics, events);
    for (const auto& file : files) text += flx::write_flx(file, flx::make_native_layout(digits));
    write_output(output, text);
  });
  py::list list;
  for (const auto& file : files) list.append(make_flx_dict(file));
  return py::make_tuple(text, list);
}

py::list read_flx(const std::string& file) {
  std::vector<flx::FlxFile> files;
  run_exclusive(file, [&] { files = analysis::read_flx_files(file); });
  py::list list;
  for (const auto& one : files) list.append(make_flx_dict(one));
  return list;
}

py::tuple integrals(const std::string& model, const std::string& matrices, const std::string& method, int digits,
                    bool inertial_loads) {
  analysis::IntegralsRequest request{model, matrices, method, digits, inertial_loads};
  analysis::IntegralsAnswer answer;
  std::string text;
  auto messages = run_request(matrices, py::none(), [&](PythonEvents& events) {
    answer = analysis::calc_integrals(request, events);
    text = flx::write_flx(answer.file, flx::make_native_layout(digits));
  });
  auto d = make_flx_dict(answer.file);
  d["flx"] = text;
  d["dof_map"] = give(std::move(answer.dof_map));
  if (answer.inertial_loads) d["inertial_loads"] = give(std::move(*answer.inertial_loads));
  return py::make_tuple(d, std::move(messages));
}

/// Texts by path, the body of a flexible-body file, and the messages. Writes nothing.
py::tuple convert(const std::string& file, const std::string& output, const std::string& units, bool radians) {
  analysis::ConvertRequest request;
  request.file = file;
  request.output = output;
  request.units = units;
  request.to_radians = radians;
  analysis::ConvertAnswer answer;
  auto messages = run_request(file, py::none(), [&](PythonEvents& events) {
    answer = analysis::convert_file(
        request, [](const std::string&, const std::vector<std::string>&) {}, events);
  });
  py::dict files;
  for (const auto& one : answer.files) files[py::str(one.path)] = one.text;
  const bool is_body = answer.kind == analysis::ConvertedKind::FlexBody && answer.files.empty();
  return py::make_tuple(files, is_body ? py::cast(std::move(answer.body)) : py::none(), answer.num_changed,
                        std::move(messages));
}

/// Ends the run when progress(time, end) returns False, or raises, or a signal of Python does.
class PythonRun final : public PythonEventsOf<analysis::RunEvents> {
 public:
  PythonRun(const py::object& progress, std::atomic<bool>& stop) : PythonEventsOf(progress), stop_(stop) {}
  void show_progress(const std::string&) override {}
  void check_output(const std::string& path, bool) override { analysis::check_place(path); }
  void show(const solver::Progress& p) override {
    const py::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress_.is_none() && progress_(p.time, p.end).is(py::bool_(false))) stop_ = true;
    } catch (py::error_already_set& raised) {
      if (!raised_) raised_ = std::make_unique<py::error_already_set>(raised);
      stop_ = true;
    }
  }
  /// With the interpreter's lock.
  void rethrow() const {
    if (raised_) throw py::error_already_set(*raised_);
  }

 private:
  std::atomic<bool>& stop_;
  std::unique_ptr<py::error_already_set> raised_;
};

py::tuple run(const std::string& file, const std::string& output, const std::string& start_from, Strings set,
              bool resume, const py::object& progress) {
  std::atomic<bool> stop{false};
  PythonRun events(progress, stop);
  analysis::RunAnswer answer;
  run_exclusive(file, [&] {
    answer = analysis::run_system({file, output, start_from, std::move(set), resume, &stop}, events);
  });
  events.rethrow();
  if (!answer.errors.empty()) throw ComputationError(answer.errors);
  py::dict d;
  put(d, "output"_a = answer.output, "was_complete"_a = answer.was_complete, "reason"_a = answer.outcome.reason);
  if (!answer.was_complete) {
    put(d, "completed"_a = answer.outcome.completed, "time"_a = answer.outcome.time,
        "steps"_a = answer.outcome.last.num_steps, "rejected"_a = answer.outcome.last.num_rejected,
        "evaluations"_a = answer.outcome.last.num_evaluations, "energy_error"_a = answer.outcome.energy_error,
        "resumed_from"_a = answer.resumed ? py::cast(*answer.resumed) : py::none(), "seconds"_a = answer.seconds,
        "events"_a = make_events(answer.events));
  }
  return py::make_tuple(d, tell(events.get_messages()));
}

/// Ends the campaign, whose finished cases stay, when a signal of Python raises.
class PythonCampaign final : public PythonEventsOf<analysis::CampaignEvents> {
 public:
  PythonCampaign(const py::object& progress, volatile int& stop) : PythonEventsOf(progress), stop_(stop) {}
  void show_progress(const std::string&) override {}
  void show(const analysis::CampaignAnswer& so_far, std::size_t num_open) override {
    const py::gil_scoped_acquire acquired;
    try {
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      if (!progress_.is_none()) progress_(so_far.num_done, num_open);
    } catch (py::error_already_set& raised) {
      if (!raised_) raised_ = std::make_unique<py::error_already_set>(raised);
      stop_ = 1;
    }
  }
  void rethrow() const {
    if (raised_) throw py::error_already_set(*raised_);
  }

 private:
  volatile int& stop_;
  std::unique_ptr<py::error_already_set> raised_;
};

py::tuple batch(const std::string& campaign, const std::string& output, int jobs, const std::string& shard,
                double time_limit, bool retry, bool restart, const py::object& progress) {
  volatile int stop = 0;
  PythonCampaign events(progress, stop);
  analysis::CampaignAnswer answer;
  run_exclusive(campaign, [&] {
    analysis::CampaignRequest request;
    request.campaign = campaign;
    request.output = output;
    request.shard = shard;
    request.jobs = jobs;
    request.time_limit = time_limit;
    request.retry = retry;
    request.restart = restart;
    request.stop = &stop;
    const analysis::BatchPlan plan(campaign, cli::list_verbs(), false);
    answer = analysis::run_campaign(request, plan, events);
  });
  events.rethrow();
  py::list failed;
  for (const auto& one : answer.failed) {
    py::dict f;
    put(f, "case"_a = one.number, "exit_code"_a = one.exit_code, "error"_a = one.error);
    failed.append(f);
  }
  py::dict statistics, d;
  for (const auto& s : answer.statistics) {
    py::dict one;
    put(one, "count"_a = s.count, "mean"_a = s.mean, "deviation"_a = s.deviation, "min"_a = s.min, "p5"_a = s.p5,
        "median"_a = s.median, "p95"_a = s.p95, "max"_a = s.max);
    statistics[py::str(s.name)] = one;
  }
  put(d, "folder"_a = answer.folder, "cases"_a = answer.num_selected, "done_before"_a = answer.num_before,
      "done"_a = answer.num_done, "failed"_a = failed, "completed"_a = answer.completed, "seconds"_a = answer.seconds,
      "statistics"_a = statistics);
  return py::make_tuple(d, tell(events.get_messages()));
}

py::dict make_random(const records::RandomOutputs& random) {
  py::dict d;
  put(d, "outputs"_a = random.outputs.name, "frequency_hz"_a = copy(random.frequency_hz), "psd"_a = copy(random.psd),
      "rms"_a = copy(random.rms), "crossing_hz"_a = copy(random.crossing_hz),
      "cumulative_rms"_a = copy(random.cumulative_rms), "band_rms"_a = copy(random.band_rms),
      "band_crossing_hz"_a = copy(random.band_crossing_hz));
  const bool has_total = random.total_rms.size() > 0;
  d["total_rms"] = has_total ? py::object(copy(random.total_rms)) : py::none();
  d["total_crossing_hz"] = has_total ? py::object(copy(random.total_crossing_hz)) : py::none();
  return d;
}

py::tuple response(const std::string& file, Strings inputs, Strings outputs, double from_hz, double to_hz, int points,
                   bool loop, Strings psd) {
  analysis::ResponseRequest request;
  request.file = file;
  request.inputs = std::move(inputs);
  request.outputs = std::move(outputs);
  request.range.from_hz = from_hz;
  request.range.to_hz = to_hz;
  if (points != 0) request.range.points = points;
  request.is_loop = loop;
  request.psd = std::move(psd);
  analysis::ResponseAnswer answer;
  auto messages =
      run_request(file, py::none(), [&](PythonEvents& events) { answer = analysis::calc_response(request, events); });
  py::dict d;
  py::list value;
  for (auto& one : answer.response.value) value.append(give(std::move(one)));
  put(d, "inputs"_a = answer.response.inputs.name, "outputs"_a = answer.response.outputs.name,
      "frequency_hz"_a = give(std::move(answer.response.frequency_hz)), "value"_a = value,
      "singular_values"_a = give(std::move(answer.response.singular_values)), "peak_gain"_a = answer.peak.value,
      "peak_hz"_a = answer.peak.frequency_hz);
  if (answer.margins) {
    const auto list = [](const std::vector<records::Crossing>& crossings) {
      py::list rows;
      for (const auto& c : crossings) rows.append(py::make_tuple(c.frequency_hz, c.margin));
      return rows;
    };
    put(d, "gain_margins"_a = list(answer.margins->gain), "phase_margins"_a = list(answer.margins->phase),
        "distance"_a = answer.margins->distance, "is_stable"_a = answer.margins->is_stable);
  }
  if (answer.random) d["random"] = make_random(*answer.random);
  return py::make_tuple(d, std::move(messages));
}

py::tuple budget(const std::string& file, const std::string& sources, Strings outputs, double from_hz, double to_hz) {
  analysis::BudgetRequest request{file, sources, std::move(outputs), {}};
  request.range.from_hz = from_hz;
  request.range.to_hz = to_hz;
  records::PointingBudget found;
  auto messages =
      run_request(file, py::none(), [&](PythonEvents& events) { found = analysis::calc_budget(request, events); });
  py::dict d;
  py::list tables, curves;
  for (auto& table : found.tables) {
    py::dict one, over_speed;
    put(one, "weighting"_a = table.weighting, "exposure"_a = table.exposure, "rms"_a = give(std::move(table.rms)),
        "speed"_a = give(std::move(table.speed)), "total"_a = give(std::move(table.total)));
    for (std::size_t s = 0; s < found.sources.size(); ++s)
      if (found.speed[s].size() > 0) over_speed[py::str(found.sources[s])] = give(std::move(table.over_speed[s]));
    one["over_speed"] = over_speed;
    tables.append(one);
  }
  py::dict speeds;
  for (std::size_t s = 0; s < found.sources.size(); ++s) {
    py::dict one;
    one["frequency_hz"] = give(std::move(found.curves[s].frequency_hz));
    one["rms"] = give(std::move(found.curves[s].rms));
    curves.append(one);
    if (found.speed[s].size() > 0) speeds[py::str(found.sources[s])] = give(std::move(found.speed[s]));
  }
  put(d, "outputs"_a = found.outputs.name, "sources"_a = found.sources, "from_hz"_a = found.from_hz,
      "to_hz"_a = found.to_hz, "tables"_a = tables, "curves"_a = curves, "speeds"_a = speeds);
  return py::make_tuple(d, std::move(messages));
}

py::tuple equilibrium(const std::string& file, Strings set) {
  analysis::EquilibriumAnswer answer;
  auto messages = run_request(file, py::none(), [&](PythonEvents& events) {
    answer = analysis::find_equilibrium(
        {file, std::move(set)}, [](const Strings&) {}, events);
  });
  py::dict d, hinges;
  for (auto& [name, q] : answer.hinges) hinges[py::str(name)] = give(std::move(q));
  py::list unstable;
  for (const auto& growth : answer.found.unstable) unstable.append(py::make_tuple(growth.mode, growth.rate));
  put(d, "q"_a = give(std::move(answer.q)), "hinges"_a = hinges, "residual"_a = answer.found.residual,
      "iterations"_a = answer.found.num_iterations, "neutral"_a = answer.found.neutral, "unstable"_a = unstable);
  return py::make_tuple(d, std::move(messages));
}

}  // namespace

void bind_commands(py::module_& m) {
  const auto none = py::none();
  const Strings no_words;
  m.def("check", &check, py::arg("file"), py::kw_only(), py::arg("set") = no_words, py::arg("subcase") = 0,
        py::arg("free") = false, py::arg("mass") = "deck", py::arg("ignore") = no_words);
  m.def("compare", &compare, py::arg("files"), py::kw_only(), py::arg("mass") = "", py::arg("refinement") = false,
        py::arg("test") = "", py::arg("deck") = "", py::arg("tam") = "serep", py::arg("sensors") = 0,
        py::arg("progress") = none);
  m.def("compare_body", &compare_body, py::arg("body"), "The integrals of a body by method.");
  m.def("edit", &edit, py::arg("file"), py::arg("commands"), py::arg("output") = "");
  m.def("info", &info, py::arg("file"));
  m.def("export", &export_file, py::arg("file"), py::arg("to"), py::arg("output") = "", py::kw_only(),
        py::arg("channels") = no_words, py::arg("ascii") = false, py::arg("moving") = false,
        py::arg("fields") = "large", py::arg("ignore") = no_words, py::arg("every") = 1,
        py::arg("window") = std::vector<double>(), py::arg("scale") = 1.0, py::arg("follow") = "",
        py::arg("bodies") = no_words, py::arg("set") = no_words, py::arg("units") = "", py::arg("fmi") = 3,
        py::arg("id") = 0, py::arg("inertia") = "6x1", py::arg("ge_order") = "mode", py::arg("digits") = 17,
        py::arg("unit") = 0, py::arg("vendor") = "nx", py::arg("first_point") = 0);
  m.def("plot", &plot, py::arg("files"), py::arg("sensors") = no_words, py::kw_only(), py::arg("labels") = no_words,
        py::arg("points") = no_words, py::arg("title") = "", py::arg("x_label") = "", py::arg("y_label") = "",
        py::arg("kind") = "", py::arg("x") = "", py::arg("psd") = false, py::arg("spectrum") = false,
        py::arg("difference") = false, py::arg("subplots") = false, py::arg("srs") = "", py::arg("output") = "",
        py::arg("inputs") = no_words, py::arg("outputs") = no_words, py::arg("per_rev") = 0,
        py::arg("window") = std::vector<double>(), py::arg("segment") = 256, py::arg("srs_part") = "maximax",
        py::arg("srs_range") = std::vector<double>(), py::arg("q") = 10.0, py::arg("log_x") = false,
        py::arg("log_y") = false, py::arg("y_min") = py::none(), py::arg("y_max") = py::none());
  m.def("report", &make_report, py::arg("files"), py::arg("output") = "", py::kw_only(), py::arg("channels") = no_words,
        py::arg("title") = "", py::arg("progress") = none);
  m.def("flx", &make_flx, py::arg("bodies"), py::arg("output") = "", py::kw_only(),
        py::arg("body_ids") = std::vector<int>{1}, py::arg("integrals") = "", py::arg("modopt") = 0,
        py::arg("digits") = 9, py::arg("special_nodes") = false, py::arg("stiffening") = false);
  m.def("read_flx", &read_flx, py::arg("file"));
  m.def("integrals", &integrals, py::arg("model"), py::arg("matrices"), py::kw_only(),
        py::arg("integrals") = "momentum", py::arg("digits") = 9, py::arg("inertial_loads") = false);
  m.def("convert", &convert, py::arg("file"), py::arg("output"), py::kw_only(), py::arg("units") = "",
        py::arg("radians") = false);
  m.def("run", &run, py::arg("file"), py::arg("output") = "", py::kw_only(), py::arg("start_from") = "",
        py::arg("set") = no_words, py::arg("resume") = false, py::arg("progress") = none);
  m.def("batch", &batch, py::arg("campaign"), py::arg("output") = "", py::kw_only(), py::arg("jobs") = 0,
        py::arg("shard") = "", py::arg("time_limit") = 0.0, py::arg("retry") = false, py::arg("restart") = false,
        py::arg("progress") = none);
  m.def("response", &response, py::arg("file"), py::kw_only(), py::arg("inputs") = no_words,
        py::arg("outputs") = no_words, py::arg("from_hz") = 0.0, py::arg("to_hz") = 0.0, py::arg("points") = 0,
        py::arg("loop") = false, py::arg("psd") = no_words);
  m.def("budget", &budget, py::arg("file"), py::arg("sources"), py::kw_only(), py::arg("outputs") = no_words,
        py::arg("from_hz") = 0.0, py::arg("to_hz") = 0.0);
  m.def("equilibrium", &equilibrium, py::arg("file"), py::kw_only(), py::arg("set") = no_words);
}

}  // namespace bough::python
