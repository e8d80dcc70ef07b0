#include "formats/hdf5/complex_modes_file.hpp"

#include "formats/hdf5/detail/columns.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {
namespace {

using Eigen::MatrixXcd;

void write_parts(FileWriter& file, const std::string& name, const std::vector<MatrixXcd>& shapes, std::size_t n,
                 const std::string& what) {
  std::vector<double> values(shapes.size() * 6 * n);
  for (const bool is_imaginary : {false, true}) {
    std::size_t i = 0;
    for (const auto& shape : shapes)
      for (Eigen::Index c = 0; c < 6; ++c)
        for (Eigen::Index j = 0; j < static_cast<Eigen::Index>(n); ++j)
          values[i++] = is_imaginary ? shape(c, j).imag() : shape(c, j).real();
    file.write_numbers("/modes/" + name + (is_imaginary ? "_imag" : "_real"), {shapes.size(), 6, n}, values.data(),
                       {what + ", " + (is_imaginary ? "imaginary" : "real") +
                            " part: node, translations x y z and rotations x y z in basic axes, mode",
                        "1, 1/L"});
  }
}

constexpr const char* kPoints[] = {"/critical", "/thresholds"};

void write_rotors(FileWriter& file, const records::RotorSpeeds& r) {
  using Rotor = std::decay_t<decltype(r.rotors.front())>;
  file.write_integers("/rotors/id", collect(r.rotors, &Rotor::id), {"ids of the rotors", "1"});
  file.write_integers("/rotors/num_grids", collect(r.rotors, &Rotor::num_grids), {"grids on the axis of each", "1"});
  file.write_integers("/rotors/num_elements", collect(r.rotors, &Rotor::num_elements), {"elements of each", "1"});
  file.write_vector("/rotors/mass", to_vector(collect(r.rotors, &Rotor::mass)), {"mass of each", "M"});
  file.write_vector("/rotors/polar_inertia", to_vector(collect(r.rotors, &Rotor::polar_inertia)),
                    {"moment of inertia of each about its axis", "M L^2"});
  file.write_attribute("/rotors", "reference", r.reference);
  file.write_attribute("/rotors", "synchronous", r.is_synchronous ? 1 : 0);
  if (const auto& s = r.sweep; s.value.size() > 0) {
    file.write_vector("/campbell/speed", s.value, {"speed of the reference rotor, radians per unit of time", "1/T"});
    file.write_matrix("/campbell/real", s.real, {"speed, branch: a column is one motion all along", "1/T"});
    file.write_matrix("/campbell/imag", s.imag, {"speed, branch", "1/T"});
    file.write_matrix("/campbell/frequency_hz", s.frequency_hz, {"imaginary part / 2 pi", "1/T"});
    file.write_matrix("/campbell/damping", s.damping, {"-real / |eigenvalue|", "1"});
    file.write_matrix("/campbell/correlation", s.correlation, {"with the motion at the speed before", "1"});
    file.write_matrix("/campbell/whirl", s.whirl, {"1: forward circle, -1: backward circle, 0: line", "1"});
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
    file.write_integers(group + "/branch", branch,
                        {is_critical ? "column of /campbell, or mode of synchronous analyses, from 0"
                                     : "column of /campbell that becomes unstable or stable, from 0",
                         "1"});
    file.write_vector(group + "/speed", values.col(0), {"of the reference rotor, radians per unit of time", "1/T"});
    file.write_vector(group + "/frequency_hz", values.col(1), {"of the motion there", "1/T"});
    file.write_vector(group + "/whirl", values.col(2), {"as /campbell/whirl", "1"});
    if (is_critical) continue;
    std::vector<int> onset;
    for (const auto& point : points) onset.push_back(point.is_onset ? 1 : 0);
    file.write_integers(group + "/onset", onset, {"1: unstable above the speed, 0: below it", "1"});
  }
}

records::RotorSpeeds read_rotors(FileReader& file) {
  records::RotorSpeeds r;
  const auto id = file.read_integers("/rotors/id", -1);
  const auto n = static_cast<long>(id.size());
  const auto grids = file.read_integers("/rotors/num_grids", n),
             elements = file.read_integers("/rotors/num_elements", n);
  const auto mass = file.read_vector("/rotors/mass", n), inertia = file.read_vector("/rotors/polar_inertia", n);
  r.reference = file.read_integer_attribute("/rotors", "reference", 0);
  r.is_synchronous = file.read_integer_attribute("/rotors", "synchronous", 0) != 0;
  file.throw_if_errors();
  for (std::size_t k = 0; k < id.size(); ++k)
    r.rotors.push_back(
        {id[k], grids[k], elements[k], mass[static_cast<Eigen::Index>(k)], inertia[static_cast<Eigen::Index>(k)]});
  if (file.has("/campbell/speed")) {
    auto& s = r.sweep;
    s.parameter = "rotor speed";
    s.value = file.read_vector("/campbell/speed", -1);
    s.real = file.read_matrix("/campbell/real", s.value.size(), -1);
    const long branches = s.real.cols();
    s.imag = file.read_matrix("/campbell/imag", s.value.size(), branches);
    s.frequency_hz = file.read_matrix("/campbell/frequency_hz", s.value.size(), branches);
    s.damping = file.read_matrix("/campbell/damping", s.value.size(), branches);
    s.correlation = file.read_matrix("/campbell/correlation", s.value.size(), branches);
    s.whirl = file.read_matrix("/campbell/whirl", s.value.size(), branches);
    std::vector<std::string> names;
    for (long b = 0; b < branches; ++b) names.push_back("mode " + std::to_string(b + 1));
    s.mode.assign(static_cast<std::size_t>(s.value.size()), names);
  }
  for (const bool is_critical : {true, false}) {
    const std::string group = kPoints[is_critical ? 0 : 1];
    const auto branch = file.read_integers(group + "/branch", -1);
    const auto count = static_cast<long>(branch.size());
    const auto speed = file.read_vector(group + "/speed", count), hz = file.read_vector(group + "/frequency_hz", count),
               whirl = file.read_vector(group + "/whirl", count);
    std::vector<int> onset(static_cast<std::size_t>(count), 1);
    if (!is_critical && file.has(group + "/onset")) onset = file.read_integers(group + "/onset", count);
    file.throw_if_errors();
    for (std::size_t k = 0; k < branch.size(); ++k) {
      const auto i = static_cast<Eigen::Index>(k);
      (is_critical ? r.critical : r.thresholds).push_back({branch[k], speed[i], hz[i], whirl[i], onset[k] != 0});
    }
  }
  return r;
}

void write_point_parts(FileWriter& file, const std::string& name, const MatrixXcd& shapes, const std::string& what) {
  file.write_matrix("/points/" + name + "_real", shapes.real(), {what + ", real part: point, mode", "1"});
  file.write_matrix("/points/" + name + "_imag", shapes.imag(), {what + ", imaginary part", "1"});
}

}  // namespace

void write_complex_modes(const records::ComplexModesResult& r, const std::string& path) {
  FileWriter file(path, "bough-complex-modes", "1.0");
  const auto n = static_cast<std::size_t>(r.eigenvalue.size());
  file.write_source(r.source);
  file.write_attribute("/", "subcase", r.subcase);
  file.write_integers("/nodes/id", r.node_id, {"ids of the nodes", "1"});
  file.write_matrix("/nodes/xyz", r.node_id.empty() ? Eigen::MatrixXd::Zero(0, 3) : r.node_xyz,
                    {"their positions, basic system", "L"});
  file.write_vector("/modes/eigenvalue_real", r.eigenvalue.real(), {"eigenvalue, real part; below 0: stable", "1/T"});
  file.write_vector("/modes/eigenvalue_imag", r.eigenvalue.imag(), {"eigenvalue, imaginary part", "1/T"});
  file.write_vector("/modes/frequency_hz", r.frequency_hz, {"imaginary part / 2 pi, cycles per unit of time", "1/T"});
  file.write_vector("/modes/damping", r.damping, {"structural damping g = -2 Re / Im, as Nastran prints it", "1"});
  file.write_vector("/modes/damping_ratio", r.damping_ratio, {"share of critical damping, -Re / abs", "1"});
  file.write_vector("/modes/residual", r.residual,
                    {"|(lambda^2 M + lambda B + K) phi| over the sum of the norms of the three terms", "1"});
  if (r.whirl.size() > 0)
    file.write_vector("/modes/whirl", r.whirl, {"1: forward circle, -1: backward circle, 0: line", "1"});
  if (r.rotors) {
    file.write_number("/modes/speed", r.speed, {"of the reference rotor; below 0: that of each mode", "1/T"});
    write_rotors(file, *r.rotors);
  }
  file.write_attribute("/modes", "method", r.is_by_modes ? "modal" : "direct");
  file.write_attribute("/modes", "norm", r.norm);
  write_parts(file, "phi", r.phi, n, "complex mode shapes");
  if (!r.left.empty())
    write_parts(file, "left", r.left, n, "left eigenvectors psi, psi^T (lambda^2 M + lambda B + K) = 0");
  if (!r.point_id.empty()) {
    file.write_integers("/points/id", r.point_id, {"ids of scalar and extra points", "1"});
    write_point_parts(file, "phi", r.point_phi, "complex mode shapes");
    if (!r.left.empty()) write_point_parts(file, "left", r.point_left, "left eigenvectors");
  }
  file.write_number("/modes/biorthogonality", r.biorthogonality,
                    {"largest off-diagonal term of Psi^T ((lambda_i + lambda_j) M + B) Phi, relative to its diagonal; "
                     "below 0: not available",
                     "1"});
  write_mesh(file, r.mesh);
  file.commit();
}

records::ComplexModesResult read_complex_modes(const std::string& path) {
  FileReader file(path, "bough-complex-modes", "1.0");
  records::ComplexModesResult r;
  r.source = file.read_source();
  r.subcase = file.read_integer_attribute("/", "subcase", 0);
  const Eigen::VectorXd real = file.read_vector("/modes/eigenvalue_real", -1);
  const long n = real.size();
  r.eigenvalue = Eigen::VectorXcd::Zero(n);
  r.eigenvalue.real() = real;
  r.eigenvalue.imag() = file.read_vector("/modes/eigenvalue_imag", n);
  r.frequency_hz = file.read_vector("/modes/frequency_hz", n);
  r.damping = file.read_vector("/modes/damping", n);
  r.damping_ratio = file.read_vector("/modes/damping_ratio", n);
  r.residual = file.read_vector("/modes/residual", n);
  if (file.has("/modes/whirl")) r.whirl = file.read_vector("/modes/whirl", n);
  if (file.has("/rotors/id")) {
    r.speed = file.read_number("/modes/speed");
    r.rotors = read_rotors(file);
  }
  r.biorthogonality = file.read_number("/modes/biorthogonality");
  r.is_by_modes = file.read_attribute("/modes", "method") == "modal";
  r.norm = file.read_attribute("/modes", "norm");
  r.node_id = file.read_integers("/nodes/id", -1);
  const auto num_nodes = static_cast<long>(r.node_id.size());
  r.node_xyz = file.read_matrix("/nodes/xyz", num_nodes, 3);
  const auto read_shapes = [&](const std::string& name, std::vector<MatrixXcd>& shapes, MatrixXcd& points) {
    if (!file.has("/modes/" + name + "_real")) return;
    shapes.assign(r.node_id.size(), MatrixXcd::Zero(6, n));
    for (const bool is_imaginary : {false, true}) {
      const std::string part = is_imaginary ? "_imag" : "_real";
      const auto data = file.read_array("/modes/" + name + part, {num_nodes, 6, n}).data;
      std::size_t i = 0;
      for (auto& shape : shapes)
        for (Eigen::Index c = 0; c < 6; ++c)
          for (Eigen::Index j = 0; j < n; ++j) is_imaginary ? shape(c, j).imag(data[i++]) : shape(c, j).real(data[i++]);
    }
    if (r.point_id.empty()) return;
    const auto num = static_cast<long>(r.point_id.size());
    points.resize(num, n);
    points.real() = file.read_matrix("/points/" + name + "_real", num, n);
    points.imag() = file.read_matrix("/points/" + name + "_imag", num, n);
  };
  if (file.has("/points/id")) r.point_id = file.read_integers("/points/id", -1);
  read_shapes("phi", r.phi, r.point_phi);
  read_shapes("left", r.left, r.point_left);
  r.mesh = read_mesh(file);
  file.throw_if_errors();
  return r;
}

}  // namespace bough::hdf5
