#include "formats/hdf5/detail/random_groups.hpp"

#include <cstdlib>

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using records::RandomCurves;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

struct Units {
  std::string plain, squared;
};
Units get_units(const RandomCurves& curves) {
  if (curves.quantity == "displacement") return {"L, 1", "L^2 T, T"};
  if (curves.quantity == "velocity") return {"L/T, 1/T", "L^2/T, 1/T"};
  if (curves.quantity == "acceleration") return {"L/T^2, 1/T^2", "L^2/T^3, 1/T^3"};
  if (curves.quantity == "stress") return {"F/L^2", "F^2 T/L^4"};
  return {"F, F L", "F^2 T, F^2 L^2 T"};
}

void write_curves(FileWriter& file, const std::string& path, const records::RandomResponse& response,
                  const RandomCurves& curves) {
  const bool of_elements = !curves.card.empty();
  const std::string group = path + (!of_elements                  ? "/" + curves.quantity
                                    : curves.quantity == "stress" ? "/stresses/" + curves.card
                                                                  : "/elements/" + curves.card);
  Dims columns{static_cast<hsize_t>(curves.rms.size())};
  if (of_elements) {
    columns = {static_cast<hsize_t>(curves.ids.size()), static_cast<hsize_t>(curves.components.size())};
    file.write_integers(group + "/id", curves.ids);
  } else {
    Eigen::MatrixXi dofs(static_cast<Eigen::Index>(curves.dofs.size()), 2);
    for (Eigen::Index i = 0; i < dofs.rows(); ++i)
      dofs.row(i) << curves.dofs[static_cast<std::size_t>(i)].first, curves.dofs[static_cast<std::size_t>(i)].second;
    file.write_integers(group + "/dofs", dofs);
  }
  const auto units = get_units(curves);
  file.set_text("unit", units.plain);
  file.set_text("square", units.squared);
  const auto write_rows = [&](const char* name, const MatrixXd& values) {
    if (values.size() == 0) return;
    Dims shape{static_cast<hsize_t>(values.rows())};
    shape.insert(shape.end(), columns.begin(), columns.end());
    const RowMajor rows = values;
    file.write_numbers(group + "/" + name, shape, rows.data());
  };
  const auto write_one = [&](const char* name, const VectorXd& values) {
    if (values.size() > 0) file.write_numbers(group + "/" + name, columns, values.data());
  };
  write_rows("psd", curves.psd);
  write_rows("cumulative_rms", records::calc_cumulative_rms(response, curves));
  write_rows("autocorrelation", curves.autocorrelation);
  write_one("rms", curves.rms);
  write_one("zero_crossings_hz", curves.crossing_hz);
  write_one("modal_rms", curves.modal_rms);
  write_one("modal_zero_crossings_hz", curves.modal_crossing_hz);
  if (of_elements) file.write_attribute(group, "components", curves.components);
}

void write_cross(FileWriter& file, const std::string& group, const records::RandomCross& cross) {
  Eigen::MatrixXi dofs(2, 2);
  dofs << cross.a.id, cross.a.component, cross.b.id, cross.b.component;
  file.make_group(group);
  file.write_attribute(group, "quantities", std::vector<std::string>{cross.a.quantity, cross.b.quantity});
  file.write_integers(group + "/dofs", dofs);
  file.write_integers(group + "/curve", {cross.curve});
  file.write_vector(group + "/real", cross.psd.real());
  file.write_vector(group + "/imag", cross.psd.imag());
  file.write_vector(group + "/coherence", cross.coherence);
  file.write_number(group + "/covariance", cross.covariance);
  if (cross.correlation.size() > 0) file.write_vector(group + "/correlation", cross.correlation);
}

records::RandomCross read_cross(FileReader& file, const std::string& group, const records::RandomResponse& response) {
  records::RandomCross cross;
  const auto quantities = file.read_attribute_words(group, "quantities");
  const auto dofs = file.read_integer_matrix(group + "/dofs", 2, 2);
  const auto curve = file.read_integers(group + "/curve", 1);
  const auto num = static_cast<long>(response.hz.size());
  const VectorXd real = file.read_vector(group + "/real", num), imag = file.read_vector(group + "/imag", num);
  cross.coherence = file.read_vector(group + "/coherence", num);
  cross.covariance = file.read_number(group + "/covariance");
  if (file.has(group + "/correlation"))
    cross.correlation = file.read_vector(group + "/correlation", static_cast<long>(response.lags.size()));
  if (quantities.size() != 2 || dofs.rows() != 2 || curve.size() != 1 || real.size() != imag.size()) return cross;
  cross.a = {quantities[0], dofs(0, 0), dofs(0, 1)};
  cross.b = {quantities[1], dofs(1, 0), dofs(1, 1)};
  cross.curve = curve[0];
  cross.psd = real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imag.cast<std::complex<double>>();
  return cross;
}

}  // namespace

void write_random(FileWriter& file, const records::RandomResponse& response) {
  const std::string path = "/random/" + std::to_string(response.set);
  file.make_group(path);
  file.write_attribute(path, "integration", response.is_loglog ? "loglog" : "linear");
  file.write_integers(path + "/subcases", response.subcases);
  file.write_vector(path + "/frequency_hz", response.hz);
  if (response.lags.size() > 0) file.write_vector(path + "/lag", response.lags);
  if (response.integral_error >= 0) file.write_number(path + "/integral_error", response.integral_error);
  for (const auto& curves : response.curves) write_curves(file, path, response, curves);
  for (std::size_t k = 0; k < response.crosses.size(); ++k)
    write_cross(file, path + "/cross/" + std::to_string(k + 1), response.crosses[k]);
}

records::RandomResponse read_random(FileReader& file, const std::string& path) {
  records::RandomResponse response;
  response.set = std::atoi(path.substr(path.rfind('/') + 1).c_str());
  response.is_loglog = file.read_attribute(path, "integration") == "loglog";
  response.subcases = file.read_integers(path + "/subcases", -1);
  response.hz = file.read_vector(path + "/frequency_hz", -1);
  if (file.has(path + "/lag")) response.lags = file.read_vector(path + "/lag", -1);
  if (file.has(path + "/integral_error")) response.integral_error = file.read_number(path + "/integral_error");
  const auto read = [&](const std::string& group, RandomCurves curves, Shape columns) {
    long count = 1;
    for (const long c : columns) count *= c;
    const auto read_rows = [&](const char* name, long rows) {
      if (!file.has(group + "/" + name)) return MatrixXd(0, 0);
      Shape shape{rows};
      shape.insert(shape.end(), columns.begin(), columns.end());
      const auto array = file.read_array(group + "/" + name, shape);
      return MatrixXd(Eigen::Map<const RowMajor>(array.data.data(), rows, count));
    };
    const auto read_one = [&](const char* name) {
      if (!file.has(group + "/" + name)) return VectorXd(0);
      const auto array = file.read_array(group + "/" + name, columns);
      return VectorXd(Eigen::Map<const VectorXd>(array.data.data(), count));
    };
    curves.psd = read_rows("psd", static_cast<long>(response.hz.size()));
    curves.autocorrelation = read_rows("autocorrelation", static_cast<long>(response.lags.size()));
    curves.rms = read_one("rms");
    curves.crossing_hz = read_one("zero_crossings_hz");
    curves.modal_rms = read_one("modal_rms");
    curves.modal_crossing_hz = read_one("modal_zero_crossings_hz");
    response.curves.push_back(std::move(curves));
  };
  for (int k = 1; file.has(path + "/cross/" + std::to_string(k)); ++k)
    response.crosses.push_back(read_cross(file, path + "/cross/" + std::to_string(k), response));
  for (const char* quantity : {"displacement", "velocity", "acceleration", "spc_force"}) {
    const std::string group = path + "/" + quantity;
    if (!file.has(group)) continue;
    RandomCurves curves;
    curves.quantity = quantity;
    const auto dofs = file.read_integer_matrix(group + "/dofs", -1, 2);
    for (Eigen::Index i = 0; i < dofs.rows(); ++i) curves.dofs.emplace_back(dofs(i, 0), dofs(i, 1));
    read(group, std::move(curves), {static_cast<long>(dofs.rows())});
  }
  for (const char* folder : {"/elements", "/stresses"}) {
    if (!file.has(path + folder)) continue;
    for (const auto& card : file.get_children(path + folder)) {
      const std::string group = path + folder + "/" + card;
      RandomCurves curves;
      curves.quantity = std::string_view(folder) == "/stresses" ? "stress" : "force";
      curves.card = card;
      curves.ids = file.read_integers(group + "/id", -1);
      curves.components = file.read_attribute_words(group, "components");
      const Shape columns{static_cast<long>(curves.ids.size()), static_cast<long>(curves.components.size())};
      read(group, std::move(curves), columns);
    }
  }
  return response;
}

}  // namespace bough::hdf5
