#include "analysis/common/control_files.hpp"

#include <algorithm>
#include <cstdlib>

#include "formats/hdf5/table_file.hpp"
#include "formats/matrices/matrix_reader.hpp"

namespace bough::analysis {
namespace {

Eigen::MatrixXd make_dense(const records::SparseMatrix& sparse) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row) {
    for (auto i = sparse.indptr[static_cast<std::size_t>(row)]; i < sparse.indptr[static_cast<std::size_t>(row) + 1];
         ++i)
      dense(row, sparse.indices[static_cast<std::size_t>(i)]) += sparse.data[static_cast<std::size_t>(i)];
  }
  return dense;
}

const std::string* find_file(const records::ControllerRecord& r) {
  const auto found = r.settings.words.find("file");
  return found == r.settings.words.end() || found->second.empty() ? nullptr : &found->second.front();
}

/// Adds what a file reports, with the table that names it.
void add_errors(const InputError& error, const std::string& user, Diagnostics& diagnostics) {
  for (auto item : error.items()) {
    item.advice += (item.advice.empty() ? "" : "; ") + std::string("named by ") + user;
    diagnostics.add(std::move(item));
  }
}

/// One column of a variable or dataset: a vector, or "name:2" of a matrix whose rows go with the time.
class ColumnFile {
 public:
  ColumnFile(const records::FunctionRecord& r, Diagnostics& diagnostics) : r_(r), diagnostics_(diagnostics) {
    is_hdf5_ = matrices::detect_format(r.file) == matrices::Format::Hdf5;
    if (!is_hdf5_) all_ = matrices::read_matrices(r.file, diagnostics);
  }

  std::vector<double> read(const std::string& text) {
    const auto colon = text.rfind(':');
    const std::string name = text.substr(0, colon);
    Eigen::MatrixXd numbers = read_whole(name);
    if (numbers.size() == 0) return {};
    if (numbers.rows() == 1) numbers.transposeInPlace();
    Eigen::Index column = 0;
    if (colon != std::string::npos) {
      char* end = nullptr;
      column = std::strtol(text.c_str() + colon + 1, &end, 10) - 1;
      if (*end != '\0') column = -1;
    } else if (numbers.cols() > 1) {
      column = -1;
    }
    if (column >= 0 && column < numbers.cols()) return {numbers.col(column).begin(), numbers.col(column).end()};
    error("takes '" + text + "' of " + r_.file + ", which has " + std::to_string(numbers.cols()) + " columns",
          "name one by its number, as " + name + ":1");
    return {};
  }

 private:
  void error(const std::string& what, const std::string& advice) {
    diagnostics_.error("function.bad-column", r_.at, "function '" + r_.name + "' " + what, advice);
  }

  Eigen::MatrixXd read_whole(const std::string& name) {
    if (is_hdf5_) return hdf5::read_numbers(r_.file, name);
    const auto found = std::find_if(all_.begin(), all_.end(), [&](const auto& m) { return m.name == name; });
    if (found != all_.end()) return make_dense(found->values);
    std::vector<std::string> names;
    for (const auto& m : all_) names.push_back(m.name);
    const std::string near = find_nearest(name, names);
    error("takes '" + name + "', which " + r_.file + " does not have",
          near.empty() ? "save it by that name" : "did you mean '" + near + "'?");
    return {};
  }

  const records::FunctionRecord& r_;
  Diagnostics& diagnostics_;
  bool is_hdf5_ = false;
  std::vector<matrices::Matrix> all_;
};

}  // namespace

void read_function_files(records::SystemSpec& spec, Diagnostics& diagnostics) {
  for (auto& r : spec.functions) {
    if (r.type != "table" || r.file.empty() || !r.x.empty()) continue;
    try {
      ColumnFile file(r, diagnostics);
      r.x = file.read(r.time_column);
      r.y = file.read(r.column);
    } catch (const InputError& error) {
      add_errors(error, "function '" + r.name + "'", diagnostics);
    }
  }
}

void read_controller_files(records::SystemSpec& spec, Diagnostics& diagnostics) {
  for (auto& r : spec.controllers) {
    if (r.type != "state_space" && r.type != "gain") continue;
    const std::string* named = find_file(r);
    if (named == nullptr) continue;
    const std::string file = *named;
    const std::vector<std::string> requested =
        r.type == "gain" ? std::vector<std::string>{"gain"} : std::vector<std::string>{"A", "B", "C", "D"};
    try {
      const bool is_hdf5 = matrices::detect_format(file) == matrices::Format::Hdf5;
      std::vector<matrices::Matrix> all;
      if (!is_hdf5) all = matrices::read_matrices(file, diagnostics);
      for (const auto& name : requested) {
        if (r.settings.has(name)) continue;
        if (is_hdf5) {
          r.settings.matrices[name] = hdf5::read_numbers(file, name);
          continue;
        }
        const auto found = std::find_if(all.begin(), all.end(), [&](const auto& m) { return m.name == name; });
        if (found != all.end()) {
          r.settings.matrices[name] = make_dense(found->values);
        } else if (name != "D") {
          diagnostics.error("control.missing-matrix", r.at, "controller '" + r.name + "': " + file + " has no " + name,
                            "save the matrices by their names");
        }
      }
    } catch (const InputError& error) {
      add_errors(error, "controller '" + r.name + "'", diagnostics);
    }
    r.settings.words.erase("file");
  }
}

std::vector<std::string> list_controller_files(const records::SystemSpec& spec) {
  std::vector<std::string> files;
  for (const auto& r : spec.controllers) {
    const std::string* file = find_file(r);
    if (file && std::find(files.begin(), files.end(), *file) == files.end()) files.push_back(*file);
  }
  return files;
}

}  // namespace bough::analysis
