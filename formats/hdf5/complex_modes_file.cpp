#include "formats/hdf5/complex_modes_file.hpp"

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
