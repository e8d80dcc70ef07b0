#include "formats/hdf5/response_file.hpp"

#include "formats/hdf5/detail/random_groups.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXd;

std::string get_dims(const std::string& quantity) {
  if (quantity == "displacement") return "L, 1";
  if (quantity == "velocity") return "L/T, 1/T";
  if (quantity == "acceleration") return "L/T^2, 1/T^2";
  return "F, F L";
}

/// `real` and `imag`, or `value` over time; samples x columns, or as `shape` folds the columns.
void write_samples(FileWriter& file, const std::string& group, const MatrixXd& real, const MatrixXd& imag,
                   const Dims& shape, std::vector<std::string>& written) {
  const auto write = [&](const char* name, const MatrixXd& values) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = values;
    file.write_numbers(group + "/" + name, shape, rows.data());
    written.push_back(group + "/" + name);
  };
  if (imag.size() == 0) return write("value", real);
  write("real", real);
  write("imag", imag);
}

void write_subcase(FileWriter& file, const records::ResponseSubcase& s, bool is_over_time) {
  const std::string path = "/subcases/" + std::to_string(s.id);
  file.make_group(path);
  file.write_attribute(path, "title", s.title);
  file.write_attribute(path, "subtitle", s.subtitle);
  file.write_attribute(path, "label", s.label);
  file.write_attribute(path, "method", s.is_direct ? "direct" : "modal");
  const std::string scale = path + (is_over_time ? "/time" : "/frequency_hz");
  file.write_vector(scale, s.x);
  std::vector<std::string> written;
  const auto rows = static_cast<hsize_t>(s.x.size());
  for (const auto& curves : s.curves) {
    const std::string group = path + "/" + curves.quantity;
    Eigen::MatrixXi dofs(static_cast<Eigen::Index>(curves.dofs.size()), 2);
    for (Eigen::Index i = 0; i < dofs.rows(); ++i) {
      const auto& [node, component] = curves.dofs[static_cast<std::size_t>(i)];
      dofs.row(i) << node, component;
    }
    file.write_integers(group + "/dofs", dofs);
    file.set_text("unit", get_dims(curves.quantity));
    write_samples(file, group, curves.real, curves.imag, {rows, static_cast<hsize_t>(dofs.rows())}, written);
    file.write_attribute(group, "phase", curves.is_phase ? 1 : 0);
    file.write_attribute(group, "punch", curves.is_punched ? 1 : 0);
  }
  for (const auto& curves : s.elements) {
    const std::string group = path + (curves.is_stress ? "/stresses/" : "/elements/") + curves.card;
    file.write_integers(group + "/id", curves.ids);
    write_samples(file, group, curves.real, curves.imag,
                  {rows, static_cast<hsize_t>(curves.ids.size()), static_cast<hsize_t>(curves.components.size())},
                  written);
    file.write_attribute(group, "components", curves.components);
    file.write_attribute(group, "phase", curves.is_phase ? 1 : 0);
    file.write_attribute(group, "punch", curves.is_punched ? 1 : 0);
  }
  file.attach_scale(scale, written);
  file.set_text("solution", s.is_direct ? "residual of the equation of motion, the worst"
                            : is_over_time
                                ? "what a step and two halves of it differ by, relative"
                                : "residual of the equation of the coordinates over its loads, worst frequency");
  file.write_number(path + "/accuracy/solution", s.solution_error);
  if (s.is_direct) return;
  file.write_number(path + "/accuracy/basis", s.basis_error);
  file.write_vector(path + "/modes/frequency_hz", s.mode_hz);
  file.write_vector(path + "/modes/damping_ratio", s.damping_ratio);
  if (!s.damped_motion.empty()) file.write_attribute(path + "/modes", "damped_motion", s.damped_motion);
  std::vector<int> residual;
  for (const auto kind : s.kind) residual.push_back(kind == records::ModeKind::Residual);
  file.write_integers(path + "/modes/is_residual", residual);
}

std::string get_format(const records::DeckResponse& response) {
  return response.is_over_time ? "bough-transient" : "bough-frequency";
}

void write_all(FileWriter& file, const records::DeckResponse& response) {
  file.write_source(response.source);
  file.make_group("/subcases");
  for (const auto& subcase : response.subcases) write_subcase(file, subcase, response.is_over_time);
  for (const auto& random : response.random) write_random(file, random);
}

void read_samples(FileReader& file, const std::string& group, long rows, const Shape& columns, bool is_over_time,
                  MatrixXd& real, MatrixXd& imag) {
  long count = 1;
  Shape shape{rows};
  for (const long c : columns) {
    count *= c;
    shape.push_back(c);
  }
  const auto read = [&](const char* name) {
    const auto array = file.read_array(group + "/" + name, shape);
    return MatrixXd(Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
        array.data.data(), rows, count));
  };
  real = read(is_over_time ? "value" : "real");
  if (!is_over_time) imag = read("imag");
}

}  // namespace

void write_response(const records::DeckResponse& response, const std::string& path) {
  FileWriter file(path, get_format(response), kResponseFormatVersion);
  write_all(file, response);
  file.commit();
}

std::string make_response_image(const records::DeckResponse& response) {
  FileWriter file(get_format(response), kResponseFormatVersion);
  write_all(file, response);
  return file.get_image();
}

records::DeckResponse read_response(const std::string& path) {
  records::DeckResponse response;
  const auto info = read_info(path);
  const auto format = info.attributes.find("format");
  response.is_over_time = format != info.attributes.end() && format->second == "bough-transient";
  FileReader file(path, response.is_over_time ? "bough-transient" : "bough-frequency", kResponseFormatVersion);
  response.source = file.read_source();
  for (const auto& name : file.get_children("/subcases")) {
    const std::string group = "/subcases/" + name;
    records::ResponseSubcase s;
    s.id = std::atoi(name.c_str());
    s.title = file.read_attribute(group, "title");
    s.subtitle = file.read_attribute(group, "subtitle");
    s.label = file.read_attribute(group, "label");
    s.x = file.read_vector(group + (response.is_over_time ? "/time" : "/frequency_hz"), -1);
    const long rows = s.x.size();
    for (const char* quantity : {"displacement", "velocity", "acceleration", "spc_force"}) {
      const std::string at = group + "/" + quantity;
      if (!file.has(at)) continue;
      records::ResponseCurves curves;
      curves.quantity = quantity;
      const auto dofs = file.read_integer_matrix(at + "/dofs", -1, 2);
      for (Eigen::Index i = 0; i < dofs.rows(); ++i) curves.dofs.emplace_back(dofs(i, 0), dofs(i, 1));
      read_samples(file, at, rows, {static_cast<long>(dofs.rows())}, response.is_over_time, curves.real, curves.imag);
      s.curves.push_back(std::move(curves));
    }
    for (const char* folder : {"/elements", "/stresses"}) {
      if (!file.has(group + folder)) continue;
      for (const auto& card : file.get_children(group + folder)) {
        const std::string at = group + folder + "/" + card;
        records::ElementCurves curves;
        curves.card = card;
        curves.is_stress = std::string_view(folder) == "/stresses";
        curves.ids = file.read_integers(at + "/id", -1);
        curves.components = file.read_attribute_words(at, "components");
        read_samples(file, at, rows,
                     {static_cast<long>(curves.ids.size()), static_cast<long>(curves.components.size())},
                     response.is_over_time, curves.real, curves.imag);
        s.elements.push_back(std::move(curves));
      }
    }
    s.is_direct = !file.has(group + "/modes");
    if (s.is_direct) {
      response.subcases.push_back(std::move(s));
      continue;
    }
    s.mode_hz = file.read_vector(group + "/modes/frequency_hz", -1);
    s.damping_ratio = file.read_vector(group + "/modes/damping_ratio", s.mode_hz.size());
    for (const int is_residual : file.read_integers(group + "/modes/is_residual", s.mode_hz.size()))
      s.kind.push_back(is_residual ? records::ModeKind::Residual : records::ModeKind::Normal);
    response.subcases.push_back(std::move(s));
  }
  if (file.has("/random"))
    for (const auto& name : file.get_children("/random"))
      response.random.push_back(read_random(file, "/random/" + name));
  file.throw_if_errors();
  return response;
}

}  // namespace bough::hdf5
