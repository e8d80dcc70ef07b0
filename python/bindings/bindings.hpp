#pragma once
/// \file The parts of the module, and what they share.
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Eigen/Dense>

#include "base/diagnostic.hpp"
#include "python/bindings/exclusive.hpp"

namespace bough::python {

namespace py = pybind11;

/// Guard of functions that use MPI, PETSc or HDF5: other Python threads continue, one thread at a time is inside.
using OneAtATime = py::call_guard<py::gil_scoped_release, Exclusive>;

/// Defines Message and the exceptions Failure, InputError, ComputationError and Warning.
void bind_messages(py::module_& m);
/// Defines Exclusive, a context in which one thread uses MPI, PETSc or HDF5.
void bind_exclusive(py::module_& m);
/// Defines reduce, modes, static and select.
void bind_analyses(py::module_& m);
/// Defines matrices, solve_response, split and init.
void bind_decks(py::module_& m);
/// Defines the functions of the other commands: check, compare, info, export, plot, report, flx and others.
void bind_commands(py::module_& m);
/// Defines FlexBody and Modes and their readers.
void bind_bodies(py::module_& m);
/// Defines LinearModel and the functions on linear models.
void bind_linear(py::module_& m);
/// Defines Event, Results, System and read_results.
void bind_systems(py::module_& m);

/// An array that shows the numbers of `data`, which `owner` keeps: nothing is copied, what is written there counts.
template <class Matrix>
py::array view(const Matrix& data, py::handle owner) {
  auto& writable = const_cast<Matrix&>(data);  // the arrays of a record that Python holds are its user's
  constexpr auto item = static_cast<py::ssize_t>(sizeof(typename Matrix::Scalar));
  const auto rows = static_cast<py::ssize_t>(data.rows()), cols = static_cast<py::ssize_t>(data.cols());
  if constexpr (Matrix::IsVectorAtCompileTime) {
    return py::array(py::dtype::of<typename Matrix::Scalar>(), {static_cast<py::ssize_t>(data.size())}, {item},
                     writable.data(), owner);
  } else {
    constexpr bool is_row_major = Matrix::IsRowMajor;
    return py::array(py::dtype::of<typename Matrix::Scalar>(), {rows, cols},
                     {is_row_major ? item * cols : item, is_row_major ? item : item * rows}, writable.data(), owner);
  }
}

/// A list of views of matrices; `owner` keeps their numbers.
template <class Matrices>
py::list view_all(const Matrices& data, py::handle owner) {
  py::list list;
  for (const auto& matrix : data) list.append(view(matrix, owner));
  return list;
}

/// An array that owns a matrix.
template <class Matrix>
py::array give(Matrix&& matrix) {
  auto* kept = new std::decay_t<Matrix>(std::forward<Matrix>(matrix));
  const py::capsule owner(kept, [](void* p) { delete static_cast<std::decay_t<Matrix>*>(p); });
  return view(*kept, owner);
}

/// Throws InputError "cli.output-is-input" if the file is one of the inputs in `source`: names, and SHA-256 of their
/// content, without which a file of this name is another one.
void demand_no_source(const std::string& path, const std::vector<std::pair<std::string, std::string>>& source);

/// save(path) of a record with its sources, none of which it overwrites.
template <class Record>
auto make_save(void (*write)(const Record&, const std::string&)) {
  return [write](const Record& record, const std::filesystem::path& path) {
    demand_no_source(path, record.source);
    write(record, path);
  };
}

/// Warnings and notes as a list; warnings go to Python's warnings too.
std::vector<Diagnostic> tell(const Diagnostics& diagnostics);

}  // namespace bough::python
