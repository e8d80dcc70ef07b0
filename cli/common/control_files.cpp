#include "cli/common/control_files.hpp"

#include <algorithm>

#include "formats/hdf5/table_file.hpp"
#include "formats/matrices/matrix_reader.hpp"

namespace bough::cli {
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

}  // namespace

void read_controller_files(records::SystemSpec& spec, Diagnostics& diagnostics) {
  for (auto& r : spec.controllers) {
    if (r.type != "state_space" && r.type != "gain") continue;
    const std::string* named = find_file(r);
    if (named == nullptr) continue;
    const std::string file = *named;
    const std::vector<std::string> wanted =
        r.type == "gain" ? std::vector<std::string>{"gain"} : std::vector<std::string>{"A", "B", "C", "D"};
    try {
      const bool is_hdf5 = matrices::detect_format(file) == matrices::Format::Hdf5;
      std::vector<matrices::Matrix> all;
      if (!is_hdf5) all = matrices::read_matrices(file, diagnostics);
      for (const auto& name : wanted) {
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
      for (auto item : error.items()) {
        item.advice += (item.advice.empty() ? "" : "; ") + std::string("named by controller '") + r.name + "'";
        diagnostics.add(std::move(item));
      }
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

}  // namespace bough::cli
