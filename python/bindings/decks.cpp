// Commands on decks as functions: matrices, frequency, transient, split, init.
#include "analysis/frequency/frequency.hpp"
#include "analysis/init/init_deck.hpp"
#include "analysis/listing/listing_files.hpp"
#include "analysis/matrices/matrices.hpp"
#include "analysis/split/split.hpp"
#include "formats/export/response_text.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/hdf5/response_file.hpp"
#include "python/bindings/requests.hpp"

namespace bough::python {

namespace {

/// The bytes of the HDF5 file, and the messages.
py::tuple matrices(const std::string& deck, std::vector<int> loads, bool no_kg, int subcase, bool free,
                   const std::string& mass, Strings ignore, const py::object& progress) {
  if (no_kg && !loads.empty()) throw py::value_error("loads are of K_G, which no_kg leaves out");
  const analysis::MatricesRequest request{deck, make_model_choice(subcase, free, mass, std::move(ignore)),
                                          std::move(loads), no_kg};
  std::string image;
  auto messages = run_request(deck, progress, [&](PythonEvents& events) {
    image = hdf5::make_matrices_image(analysis::assemble_matrices(request, events));
  });
  return py::make_tuple(py::bytes(image), std::move(messages));
}

/// The bytes of the HDF5 file, and the messages.
py::tuple solve_response(const std::string& deck, bool is_over_time, std::vector<int> grids, bool direct, bool modal,
                         int number, std::optional<double> max_hz, bool no_residuals, int subcase, bool free,
                         const std::string& mass, Strings ignore, bool linear, const std::string& csv,
                         const std::string& punch, const std::string& f06, const std::string& op2,
                         const py::object& progress) {
  const analysis::ListingFiles listing{f06, op2};
  if (direct && (modal || number > 0 || max_hz || no_residuals))
    throw py::value_error("direct is without modes: leave out modal, number, max_hz and no_residuals");
  if (number < 0) throw py::value_error("number is a number of modes above 0, not " + std::to_string(number));
  if (max_hz && !(*max_hz > 0)) throw py::value_error("max_hz is a frequency above 0, not " + std::to_string(*max_hz));
  analysis::DeckResponseRequest request;
  request.deck = deck;
  request.model = make_model_choice(subcase, free, mass, std::move(ignore));
  request.eigen.number = number;
  request.eigen.max_hz = max_hz;
  request.is_transient = is_over_time;
  request.is_direct = direct;
  request.is_modal = modal;
  request.is_linear = linear;
  request.no_residuals = no_residuals;
  request.grids = std::move(grids);
  request.has_listing = !listing.empty();
  std::string image;
  auto messages = run_request(deck, progress, [&](PythonEvents& events) {
    announce_outputs({csv, punch, f06, op2});
    const auto answer = analysis::solve_deck_response(request, events);
    if (!answer.failures.is_empty()) answer.failures.throw_all(events.get_messages());
    image = hdf5::make_response_image(answer.response);
    if (!csv.empty()) write_output(csv, exports::make_response_csv(answer.response));
    if (!punch.empty()) write_output(punch, exports::make_punch_text(answer.response));
    if (answer.listing) analysis::write_listings(listing, *answer.listing);
  });
  return py::make_tuple(py::bytes(image), std::move(messages));
}

py::dict list_texts(const std::vector<analysis::StartFile>& files) {
  py::dict texts;
  for (const auto& file : files) texts[py::str(file.name)] = file.text;
  return texts;
}

/// Texts of the files by name, the parts with their bodies, the frequencies, and the messages. Writes nothing.
py::tuple split(const std::string& deck, int parts, const std::string& along, Strings planes, Strings elements,
                std::vector<int> grids, const std::string& interface, const std::string& name, int modes, bool check,
                int subcase, Strings ignore, const py::object& progress) {
  analysis::SplitRequest request;
  request.deck = deck;
  request.name = name;
  request.model = make_model_choice(subcase, false, "deck", std::move(ignore));
  request.choice = {parts, along, std::move(planes), std::move(elements), std::move(grids), interface};
  request.is_checked = check;
  request.num_compared = modes;
  analysis::SplitAnswer answer;
  auto messages =
      run_request(deck, progress, [&](PythonEvents& events) { answer = analysis::split_deck(request, events); });
  py::list made, frequencies, deflections;
  for (auto& part : answer.parts) {
    py::dict one;
    put(one, "name"_a = part.name, "parent"_a = part.parent, "node"_a = part.node, "joined_grids"_a = part.num_joined,
        "elements"_a = part.num_elements, "grids"_a = part.num_grids, "mass"_a = part.mass,
        "body"_a = check ? py::cast(std::move(part.body)) : py::none());
    made.append(one);
  }
  for (const auto& frequency : answer.frequencies)
    frequencies.append(py::make_tuple(frequency.whole_hz, frequency.parts_hz));
  for (const auto& deflection : answer.deflections)
    deflections.append(py::make_tuple(deflection.load, deflection.deflection, deflection.error));
  py::dict d;
  put(d, "mass"_a = answer.mass, "parts"_a = made, "frequencies"_a = frequencies, "deflections"_a = deflections,
      "files"_a = list_texts(answer.files));
  return py::make_tuple(d, std::move(messages));
}

/// Texts of the files by name, and the messages. Writes nothing.
py::tuple init(const std::string& deck, const std::string& folder, int hinge) {
  std::vector<analysis::StartFile> files;
  auto messages = run_request(deck, py::none(), [&](PythonEvents& events) {
    Diagnostics notes;
    files = analysis::make_start_files(deck, folder, hinge, notes);
    analysis::add_messages(notes, events);
  });
  return py::make_tuple(list_texts(files), std::move(messages));
}

}  // namespace

void bind_decks(py::module_& m) {
  const auto none = py::none();
  m.def("matrices", &matrices, py::arg("deck"), py::kw_only(), py::arg("loads") = std::vector<int>(),
        py::arg("no_kg") = false, py::arg("subcase") = 0, py::arg("free") = false, py::arg("mass") = "deck",
        py::arg("ignore") = Strings(), py::arg("progress") = none, "The bytes of the file of bough matrices.");
  m.def("solve_response", &solve_response, py::arg("deck"), py::arg("is_over_time"), py::kw_only(),
        py::arg("grids") = std::vector<int>(), py::arg("direct") = false, py::arg("modal") = false,
        py::arg("number") = 0, py::arg("max_hz") = none, py::arg("no_residuals") = false, py::arg("subcase") = 0,
        py::arg("free") = false, py::arg("mass") = "deck", py::arg("ignore") = Strings(), py::arg("linear") = false,
        py::arg("csv") = "", py::arg("punch") = "", py::arg("f06") = "", py::arg("op2") = "",
        py::arg("progress") = none, "The bytes of the file of bough frequency or bough transient.");
  m.def("split", &split, py::arg("deck"), py::kw_only(), py::arg("parts") = 0, py::arg("along") = "path",
        py::arg("planes") = Strings(), py::arg("elements") = Strings(), py::arg("grids") = std::vector<int>(),
        py::arg("interface") = "rigid", py::arg("name") = "", py::arg("modes") = 10, py::arg("check") = true,
        py::arg("subcase") = 0, py::arg("ignore") = Strings(), py::arg("progress") = none);
  m.def("init", &init, py::arg("deck"), py::kw_only(), py::arg("folder") = "", py::arg("hinge") = 0);
}

}  // namespace bough::python
