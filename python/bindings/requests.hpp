#pragma once
/// \file Requests of Python: messages and progress, the locks, choices of a model.
#include "analysis/common/events.hpp"
#include "analysis/common/failures.hpp"
#include "analysis/common/model_choice.hpp"
#include "analysis/common/output_folder.hpp"
#include "analysis/common/text_file.hpp"
#include "base/file_roles.hpp"
#include "fe/linear/petsc.hpp"
#include "python/bindings/bindings.hpp"

namespace bough::python {

using Strings = std::vector<std::string>;
using namespace py::literals;

/// Sets entries of a dict: put(d, "mass"_a = 2.0, "names"_a = names).
template <class... Entries>
void put(py::dict& dict, Entries&&... entries) {
  dict.attr("update")(std::forward<Entries>(entries)...);
}

/// Keeps messages for Python's warnings; progress(stage) of Python is called with the interpreter's lock.
template <class Base>
class PythonEventsOf : public Base {
 public:
  explicit PythonEventsOf(const py::object& progress) : progress_(progress) {}
  void add_message(const Diagnostic& message) override { messages_.add(message); }
  void show_progress(const std::string& stage) override {
    if (progress_.is_none() || stage.empty()) return;
    const py::gil_scoped_acquire acquired;
    progress_(stage);
  }
  /// Messages so far.
  const Diagnostics& get_messages() const { return messages_; }

 protected:
  const py::object& progress_;
  Diagnostics messages_;
};
using PythonEvents = PythonEventsOf<analysis::Events>;

/// Runs act() with the lock of the module and without that of the interpreter; failures get the location `file`. A file
/// that act() reads is not overwritten by it: InputError "cli.output-is-input".
template <class Act>
void run_exclusive(const std::string& file, const Act& act) {
  const py::gil_scoped_release released;
  const Exclusive held;
  const FileRoles roles;
  linear::initialize_petsc();
  analysis::with_file(file, [&] {
    act();
    return 0;
  });
}

/// Runs act(events) likewise. Gives the messages, of which warnings are Python's too.
template <class Act>
std::vector<Diagnostic> run_request(const std::string& file, const py::object& progress, const Act& act) {
  PythonEvents events(progress);
  run_exclusive(file, [&] { act(events); });
  return tell(events.get_messages());
}

/// Before the work: refuses an output outside of the folder that a campaign allows; inputs that are read from now on
/// are not to be this file. Empty: no output.
inline void announce_output(const std::string& output) {
  if (output.empty()) return;
  analysis::check_place(output);
  note_output(output);
}

/// announce_output for each path that is not empty; throws InputError "cli.same-output" if two are one file.
inline void announce_outputs(const Strings& outputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    announce_output(outputs[i]);
    for (std::size_t k = 0; k < i; ++k)
      if (!outputs[k].empty() && analysis::is_same_output(outputs[k], outputs[i]))
        throw InputError("cli.same-output", {outputs[i]}, "two outputs of this call would be this one file",
                         "give each a separate name");
  }
}

/// Writes the text unless `output` is empty.
inline void write_output(const std::string& output, const std::string& text) {
  if (!output.empty()) analysis::write_text_file(output, text);
}

/// Throws ValueError for a word that names no mass matrix.
analysis::ModelChoice make_model_choice(int subcase, bool free, const std::string& mass, Strings ignore);

}  // namespace bough::python
