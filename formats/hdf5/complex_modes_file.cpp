#include "formats/hdf5/complex_modes_file.hpp"

#include "formats/hdf5/detail/columns.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXcd;

void write_parts(FileWriter& file, const std::string& name, const std::vector<MatrixXcd>& shapes, std::size_t n) {
  std::vector<double> values(shapes.size() * 6 * n);
  for (const bool is_imaginary : {false, true}) {
    std::size_t i = 0;
    for (const auto& shape : shapes)
      for (Eigen::Index c = 0; c < 6; ++c)
        for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(n); ++j)
          values[i++] = is_imaginary ? shape(c, j).imag() : shape(c, j).real();
    file.write_numbers("/modes/" + name + (is_imaginary ? "_imag" : "_real"), {shapes.size(), 6, n}, values.data());
  }
}

constexpr const char* kPoints[] = {"/critical", "/thresholds"};

void write_rotors(FileWriter& file, const records::RotorSpeeds& r) {
  using Rotor = std::decay_t<decltype(r.rotors.front())>;
  file.write_integers("/rotors/id", collect(r.rotors, &Rotor::id));
  file.write_integers("/rotors/num_grids", collect(r.rotors, &Rotor::num_grids));
  file.write_integers("/rotors/num_elements", collect(r.rotors, &Rotor::num_elements));
  file.write_vector("/rotors/mass", to_vector(collect(r.rotors, &Rotor::mass)));
  file.write_vector("/rotors/polar_inertia", to_vector(collect(r.rotors, &Rotor::polar_inertia)));
  file.write_attribute("/rotors", "reference", r.reference);
  file.write_attribute("/rotors", "synchronous", r.is_synchronous ? 1 : 0);
  if (const auto& s = r.sweep; s.value.size() > 0) {
    file.write_vector("/campbell/speed", s.value);
    file.write_matrix("/campbell/real", s.real);
    file.write_matrix("/campbell/imag", s.imag);
    file.write_matrix("/campbell/frequency_hz", s.frequency_hz);
    file.write_matrix("/campbell/damping", s.damping);
    file.write_matrix("/campbell/correlation", s.correlation);
    file.write_matrix("/campbell/whirl", s.whirl);
    file.attach_scale("/campbell/speed", {"/campbell/real", "/campbell/imag", "/campbell/frequency_hz",
                                          "/campbell/damping", "/campbell/correlation", "/campbell/whirl"});
  }
  for (const bool is_critical : {true, false}) {
    const auto& points = is_critical ? r.critical : r.thresholds;
    const std::string group = kPoints[is_critical ? 0 : 1];
    std::vector<int> branch;
    Eigen::MatrixXd values(static_cast<Eigen::Index>(points.size()), 3);
    for (const auto& point : points) {
      values.row(static_cast<Eigen::Index>(branch.size())) << point.speed, point.frequency_hz, point.whirl;
      branch.push_back(point.branch);
    }
    file.write_integers(group + "/branch", branch);
    file.write_vector(group + "/speed", values.col(0));
    file.write_vector(group + "/frequency_hz", values.col(1));
    file.write_vector(group + "/whirl", values.col(2));
    if (is_critical) continue;
    std::vector<int> onset;
    for (const auto& point : points) onset.push_back(point.is_onset ? 1 : 0);
    file.write_integers(group + "/onset", onset);
  }
}

records::RotorSpeeds read_rotors(FileReader& file) {
  records::RotorSpeeds r;
  const auto id = file.read_integers("/rotors/id");
  const auto grids = file.read_integers("/rotors/num_grids"), elements = file.read_integers("/rotors/num_elements");
  const auto mass = file.read_vector("/rotors/mass"), inertia = file.read_vector("/rotors/polar_inertia");
  r.reference = file.read_integer_attribute("/rotors", "reference", 0);
  r.is_synchronous = file.read_integer_attribute("/rotors", "synchronous", 0) != 0;
  file.throw_if_errors();
  for (std::size_t k = 0; k < id.size(); ++k)
    r.rotors.push_back(
        {id[k], grids[k], elements[k], mass[static_cast<Eigen::Index>(k)], inertia[static_cast<Eigen::Index>(k)]});
  if (file.has("/campbell/speed")) {
    auto& s = r.sweep;
    s.parameter = "rotor speed";
    s.value = file.read_vector("/campbell/speed");
    s.real = file.read_matrix("/campbell/real");
    const long branches = s.real.cols();
    s.imag = file.read_matrix("/campbell/imag");
    s.frequency_hz = file.read_matrix("/campbell/frequency_hz");
    s.damping = file.read_matrix("/campbell/damping");
    s.correlation = file.read_matrix("/campbell/correlation");
    s.whirl = file.read_matrix("/campbell/whirl");
    std::vector<std::string> names;
    for (long b = 0; b < branches; ++b) names.push_back("mode " + std::to_string(b + 1));
    s.mode.assign(static_cast<std::size_t>(s.value.size()), names);
  }
  for (const bool is_critical : {true, false}) {
    const std::string group = kPoints[is_critical ? 0 : 1];
    const auto branch = file.read_integers(group + "/branch");
    const auto count = static_cast<long>(branch.size());
    const auto speed = file.read_vector(group + "/speed"), hz = file.read_vector(group + "/frequency_hz"),
               whirl = file.read_vector(group + "/whirl");
    std::vector<int> onset(static_cast<std::size_t>(count), 1);
    if (!is_critical && file.has(group + "/onset")) onset = file.read_integers(group + "/onset");
    file.throw_if_errors();
    for (std::size_t k = 0; k < branch.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      (is_critical ? r.critical : r.thresholds).push_back({branch[k], speed[i], hz[i], whirl[i], onset[k] != 0});
    }
  }
  return r;
}

void write_point_parts(FileWriter& file, const std::string& name, const MatrixXcd& shapes) {
  file.write_matrix("/points/" + name + "_real", shapes.real());
  file.write_matrix("/points/" + name + "_imag", shapes.imag());
}

}  // namespace

void write_complex_modes(const records::ComplexModesResult& r, const std::string& path) {
  FileWriter file(path, "bough-complex-modes", "1.0");
  const auto n = static_cast<std::size_t>(r.eigenvalue.size());
  file.write_source(r.source);
  file.write_attribute("/", "subcase", r.subcase);
  file.write_integers("/nodes/id", r.node_id);
  file.write_matrix("/nodes/xyz", r.node_id.empty() ? Eigen::MatrixXd::Zero(0, 3) : r.node_xyz);
  file.write_vector("/modes/eigenvalue_real", r.eigenvalue.real());
  file.write_vector("/modes/eigenvalue_imag", r.eigenvalue.imag());
  file.write_vector("/modes/frequency_hz", r.frequency_hz);
  file.write_vector("/modes/damping", r.damping);
  file.write_vector("/modes/damping_ratio", r.damping_ratio);
  file.write_vector("/modes/residual", r.residual);
  if (r.whirl.size() > 0) file.write_vector("/modes/whirl", r.whirl);
  if (r.rotors) {
    file.write_number("/modes/speed", r.speed);
    write_rotors(file, *r.rotors);
  }
  file.write_attribute("/modes", "method", r.is_by_modes ? "modal" : "direct");
  file.write_attribute("/modes", "norm", r.norm);
  write_parts(file, "phi", r.phi, n);
  if (!r.left.empty()) write_parts(file, "left", r.left, n);
  if (!r.point_id.empty()) {
    file.write_integers("/points/id", r.point_id);
    write_point_parts(file, "phi", r.point_phi);
    if (!r.left.empty()) write_point_parts(file, "left", r.point_left);
  }
  file.write_number("/modes/biorthogonality", r.biorthogonality);
  write_mesh(file, r.mesh);
  file.commit();
}

records::ComplexModesResult read_complex_modes(const std::string& path) {
  FileReader file(path, "bough-complex-modes", "1.0");
  records::ComplexModesResult r;
  r.source = file.read_source();
  r.subcase = file.read_integer_attribute("/", "subcase", 0);
  const Eigen::VectorXd real = file.read_vector("/modes/eigenvalue_real");
  const long n = real.size();
  r.eigenvalue = Eigen::VectorXcd::Zero(n);
  r.eigenvalue.real() = real;
  r.eigenvalue.imag() = file.read_vector("/modes/eigenvalue_imag");
  r.frequency_hz = file.read_vector("/modes/frequency_hz");
  r.damping = file.read_vector("/modes/damping");
  r.damping_ratio = file.read_vector("/modes/damping_ratio");
  r.residual = file.read_vector("/modes/residual");
  if (file.has("/modes/whirl")) r.whirl = file.read_vector("/modes/whirl");
  if (file.has("/rotors/id")) {
    r.speed = file.read_number("/modes/speed");
    r.rotors = read_rotors(file);
  }
  r.biorthogonality = file.read_number("/modes/biorthogonality");
  r.is_by_modes = file.read_attribute("/modes", "method") == "modal";
  r.norm = file.read_attribute("/modes", "norm");
  r.node_id = file.read_integers("/nodes/id");
  r.node_xyz = file.read_matrix("/nodes/xyz");
  const auto read_shapes = [&](const std::string& name, std::vector<MatrixXcd>& shapes, MatrixXcd& points) {
    if (!file.has("/modes/" + name + "_real")) return;
    shapes.assign(r.node_id.size(), MatrixXcd::Zero(6, n));
    for (const bool is_imaginary : {false, true}) {
      const std::string part = is_imaginary ? "_imag" : "_real";
      const auto data = file.read_array("/modes/" + name + part).data;
      std::size_t i = 0;
      for (auto& shape : shapes)
        for (Eigen::Index c = 0; c < 6; ++c)
          for (Eigen::Index j = 0; j < n; ++j) is_imaginary ? shape(c, j).imag(data[i++]) : shape(c, j).real(data[i++]);
    }
    if (r.point_id.empty()) return;
    const auto num = static_cast<long>(r.point_id.size());
    points.resize(num, n);
    points.real() = file.read_matrix("/points/" + name + "_real");
    points.imag() = file.read_matrix("/points/" + name + "_imag");
  };
  if (file.has("/points/id")) r.point_id = file.read_integers("/points/id");
  read_shapes("phi", r.phi, r.point_phi);
  read_shapes("left", r.left, r.point_left);
  r.mesh = read_mesh(file);
  file.throw_if_errors();
  return r;
}

}  // namespace bough::hdf5
