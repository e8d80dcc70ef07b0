// Commands as functions whose records are dicts: check, compare, info, export, plot, report, flx, integrals, convert,
// run, batch, response, equilibrium.
#include <atomic>

#include "analysis/campaign/campaign.hpp"
#include "analysis/check/check.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "analysis/compare/compare.hpp"
#include "analysis/convert/convert.hpp"
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
  mass["mass"] = p.mass;
  mass["cg"] = copy(p.cg);
  mass["inertia"] = copy(p.inertia);
  return mass;
}

py::list make_events(const std::vector<records::EventRecord>& events) {
  py::list list;
  for (const auto& event : events) {
    py::dict one;
    one["time"] = event.time;
    one["what"] = event.what;
    one["source"] = event.source;
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
  d["num_nodes"] = check.model->nodes().size();
  d["num_elements"] = check.model->elements().size();
  d["num_dofs"] = check.model->num_gdofs();
  d["num_free_dofs"] = check.model->num_fdofs();
  d["mass_properties"] = make_mass(check.mass);
  d["ground_check"] = copy(check.ground.g);
  d["ground_check_n"] = copy(check.ground.n);
  d["ground_check_f"] = copy(check.ground.f);
  py::list autospc, subcases;
  for (const auto& entry : check.model->autospc()) autospc.append(py::make_tuple(entry.node, entry.component));
  for (const auto& row : check.subcases) {
    py::dict one;
    one["id"] = row.subcase.id;
    one["load_set"] = row.subcase.load;
    one["resultant"] = row.is_resolved ? py::object(copy(row.resultant)) : py::none();
    one["num_enforced"] = row.num_enforced;
    one["num_heated"] = row.num_heated;
    subcases.append(one);
  }
  d["autospc"] = autospc;
  d["subcases"] = subcases;
}
void describe(const analysis::BodyCheck& check, py::dict& d) {
  if (check.deck) describe(*check.deck, d);
  d["kind"] = "body";
  d["name"] = check.spec.name;
  d["deck"] = check.spec.deck;
}
void describe(const analysis::SystemCheck& check, py::dict& d) {
  d["kind"] = "system";
  const auto& system = check.loaded.system;
  py::list bodies;
  for (int b = 0; b < system.num_bodies(); ++b) {
    py::dict one;
    one["name"] = system.body_name(b);
    one["hinge"] = system.hinge_name(b);
    one["num_hinge_dofs"] = system.num_hinge_u(b);
    one["num_modes"] = system.num_modes(b);
    bodies.append(one);
  }
  d["bodies"] = bodies;
  d["num_speeds"] = system.num_dofs();
}
void describe(const analysis::FlexBodyCheck& check, py::dict& d) {
  d["kind"] = "bough-flexbody";
  d["name"] = check.name;
  d["mass"] = check.mass;
  d["frequency_hz"] = copy(check.frequency_hz);
  d["num_nodes"] = check.num_nodes;
  d["num_interface_nodes"] = check.num_interface_nodes;
  d["num_locators"] = check.num_locators;
  d["kg_asymmetry"] = check.kg_asymmetry;
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
  d["kind"] = "bough-results";
  d["num_samples"] = check.num_samples;
  d["start"] = check.start;
  d["end"] = check.end;
  d["num_channels"] = check.num_channels;
  d["completed"] = check.completed;
  d["reason"] = check.reason;
}
void describe(const analysis::ModesCheck& check, py::dict& d) {
  d["kind"] = "bough-modes";
  d["num_modes"] = check.num_modes;
  d["num_rigid_modes"] = check.num_rigid_modes;
  d["num_grids"] = check.num_grids;
}
void describe(const analysis::StaticCheck& check, py::dict& d) {
  d["kind"] = "bough-static";
  py::list subcases;
  for (const auto& subcase : check.subcases) {
    py::dict one;
    one["id"] = subcase.id;
    one["load_set"] = subcase.load_set;
    one["elements"] = subcase.elements;
    subcases.append(one);
  }
  d["subcases"] = subcases;
}
void describe(const analysis::MatricesCheck& check, py::dict& d) {
  d["kind"] = "bough-matrices";
  d["names"] = check.names;
}
void describe(const analysis::LinearCheck& check, py::dict& d) {
  d["kind"] = "bough-linear";
  d["num_states"] = check.num_states;
  d["num_inputs"] = check.num_inputs;
  d["num_outputs"] = check.num_outputs;
  d["time"] = check.time;
  d["error"] = check.error;
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
py::tuple compare(Strings files, const std::string& mass, bool refinement, const py::object& progress) {
  analysis::CompareRequest request{std::move(files), mass, refinement};
  records::Comparison comparison;
  auto messages = run_request(request.files.empty() ? "" : request.files.front(), progress, [&](PythonEvents& events) {
    comparison = analysis::make_comparison(request, analysis::compare_files(request, events));
  });
  py::dict d;
  const auto get_name = [](const std::string& path) { return py::str(path.starts_with('/') ? path.substr(1) : path); };
  for (auto& array : comparison.arrays) {
    if (array.values.cols() == 1)
      d[get_name(array.path)] = give(Eigen::VectorXd(array.values.col(0)));
    else
      d[get_name(array.path)] = give(std::move(array.values));
  }
  for (const auto& [path, words] : comparison.words) d[get_name(path)] = words;
  return py::make_tuple(d, std::move(messages));
}

py::dict info(const std::string& file) {
  analysis::InfoAnswer answer;
  run_exclusive(file, [&] { answer = analysis::list_contents(file); });
  py::dict d, attributes;
  for (const auto& [name, value] : answer.info.attributes) attributes[py::str(name)] = value;
  py::list objects;
  for (const auto& object : answer.info.objects) {
    py::dict one;
    one["path"] = object.path;
    one["shape"] = object.shape;
    one["type"] = object.type;
    one["description"] = object.description;
    one["dims"] = object.dims;
    objects.append(one);
  }
  d["attributes"] = attributes;
  d["objects"] = objects;
  d["events"] = make_events(answer.events);
  return d;
}

/// The bytes of the file, or what there is to say of the files that were written, and the messages.
py::tuple export_file(const std::string& file, const std::string& to, const std::string& output, Strings channels,
                      bool ascii, bool moving, const std::string& fields, Strings ignore, int every,
                      std::vector<double> window, double scale, const std::string& follow, Strings bodies, Strings set,
                      const std::string& units, int fmi, int id) {
  analysis::ExportRequest request;
  request.file = file;
  request.output = output;
  request.format = to;
  request.channels = channels;
  request.is_ascii = ascii;
  request.is_moving = moving;
  request.fields = fields;
  request.ignore_cards = std::move(ignore);
  request.moving = {every, std::move(window), scale, follow, std::move(bodies)};
  request.fmu = {fmi, std::move(channels), std::move(set), units};
  request.component.id = id;
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
               const std::string& output) {
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
      c["label"] = curve.label;
      c["x"] = copy(curve.x);
      c["y"] = copy(curve.y);
      curves.append(c);
    }
    py::dict p;
    p["title"] = one.title;
    p["x_label"] = one.x_label;
    p["y_label"] = one.y_label;
    p["curves"] = curves;
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
  d["body_id"] = file.body_id;
  d["name"] = file.name;
  d["method"] = file.method;
  d["mass"] = file.mass;
  d["modes"] = file.modes;
  d["M"] = copy(file.M);
  d["K"] = copy(file.K);
  d["D"] = copy(file.D);
  d["alpha"] = copy(file.alpha);
  d["integrals"] = file.integrals;
  d["node_id"] = file.node_id;
  d["node_xyz"] = copy(file.node_xyz);
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
  run_exclusive(request.bodies.empty() ? "" : request.bodies.front(), [&] {
    announce_output(output);
    files = analysis::make_flx_files(request);
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
  d["output"] = answer.output;
  d["was_complete"] = answer.was_complete;
  d["reason"] = answer.outcome.reason;
  if (!answer.was_complete) {
    d["completed"] = answer.outcome.completed;
    d["time"] = answer.outcome.time;
    d["steps"] = answer.outcome.last.num_steps;
    d["rejected"] = answer.outcome.last.num_rejected;
    d["evaluations"] = answer.outcome.last.num_evaluations;
    d["energy_error"] = answer.outcome.energy_error;
    d["resumed_from"] = answer.resumed ? py::cast(*answer.resumed) : py::none();
    d["seconds"] = answer.seconds;
    d["events"] = make_events(answer.events);
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
    f["case"] = one.number;
    f["exit_code"] = one.exit_code;
    f["error"] = one.error;
    failed.append(f);
  }
  py::dict statistics, d;
  for (const auto& s : answer.statistics) {
    py::dict one;
    one["count"] = s.count;
    one["mean"] = s.mean;
    one["deviation"] = s.deviation;
    one["min"] = s.min;
    one["p5"] = s.p5;
    one["median"] = s.median;
    one["p95"] = s.p95;
    one["max"] = s.max;
    statistics[py::str(s.name)] = one;
  }
  d["folder"] = answer.folder;
  d["cases"] = answer.num_selected;
  d["done_before"] = answer.num_before;
  d["done"] = answer.num_done;
  d["failed"] = failed;
  d["completed"] = answer.completed;
  d["seconds"] = answer.seconds;
  d["statistics"] = statistics;
  return py::make_tuple(d, tell(events.get_messages()));
}

py::dict make_random(const records::RandomOutputs& random) {
  py::dict d;
  d["outputs"] = random.outputs.name;
  d["frequency_hz"] = copy(random.frequency_hz);
  d["psd"] = copy(random.psd);
  d["rms"] = copy(random.rms);
  d["crossing_hz"] = copy(random.crossing_hz);
  d["cumulative_rms"] = copy(random.cumulative_rms);
  d["band_rms"] = copy(random.band_rms);
  d["band_crossing_hz"] = copy(random.band_crossing_hz);
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
  d["inputs"] = answer.response.inputs.name;
  d["outputs"] = answer.response.outputs.name;
  d["frequency_hz"] = give(std::move(answer.response.frequency_hz));
  d["value"] = value;
  d["singular_values"] = give(std::move(answer.response.singular_values));
  d["peak_gain"] = answer.peak.value;
  d["peak_hz"] = answer.peak.frequency_hz;
  if (answer.margins) {
    const auto list = [](const std::vector<records::Crossing>& crossings) {
      py::list rows;
      for (const auto& c : crossings) rows.append(py::make_tuple(c.frequency_hz, c.margin));
      return rows;
    };
    d["gain_margins"] = list(answer.margins->gain);
    d["phase_margins"] = list(answer.margins->phase);
    d["distance"] = answer.margins->distance;
    d["is_stable"] = answer.margins->is_stable;
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
    one["weighting"] = table.weighting;
    one["exposure"] = table.exposure;
    one["rms"] = give(std::move(table.rms));
    one["speed"] = give(std::move(table.speed));
    one["total"] = give(std::move(table.total));
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
  d["outputs"] = found.outputs.name;
  d["sources"] = found.sources;
  d["from_hz"] = found.from_hz;
  d["to_hz"] = found.to_hz;
  d["tables"] = tables;
  d["curves"] = curves;
  d["speeds"] = speeds;
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
  d["q"] = give(std::move(answer.q));
  d["hinges"] = hinges;
  d["residual"] = answer.found.residual;
  d["iterations"] = answer.found.num_iterations;
  d["neutral"] = answer.found.neutral;
  d["unstable"] = unstable;
  return py::make_tuple(d, std::move(messages));
}

}  // namespace

void bind_commands(py::module_& m) {
  const auto none = py::none();
  const Strings no_words;
  m.def("check", &check, py::arg("file"), py::kw_only(), py::arg("set") = no_words, py::arg("subcase") = 0,
        py::arg("free") = false, py::arg("mass") = "deck", py::arg("ignore") = no_words);
  m.def("compare", &compare, py::arg("files"), py::kw_only(), py::arg("mass") = "", py::arg("refinement") = false,
        py::arg("progress") = none);
  m.def("info", &info, py::arg("file"));
  m.def("export", &export_file, py::arg("file"), py::arg("to"), py::arg("output") = "", py::kw_only(),
        py::arg("channels") = no_words, py::arg("ascii") = false, py::arg("moving") = false,
        py::arg("fields") = "large", py::arg("ignore") = no_words, py::arg("every") = 1,
        py::arg("window") = std::vector<double>(), py::arg("scale") = 1.0, py::arg("follow") = "",
        py::arg("bodies") = no_words, py::arg("set") = no_words, py::arg("units") = "", py::arg("fmi") = 3,
        py::arg("id") = 0);
  m.def("plot", &plot, py::arg("files"), py::arg("sensors") = no_words, py::kw_only(), py::arg("labels") = no_words,
        py::arg("points") = no_words, py::arg("title") = "", py::arg("x_label") = "", py::arg("y_label") = "",
        py::arg("kind") = "", py::arg("x") = "", py::arg("psd") = false, py::arg("spectrum") = false,
        py::arg("difference") = false, py::arg("subplots") = false, py::arg("srs") = "", py::arg("output") = "");
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
