#include "analysis/export/export_bodies.hpp"

#include <fmt/format.h>

#include "analysis/common/body_files.hpp"
#include "analysis/export/export_matrices.hpp"
#include "formats/flat/flex_body.hpp"
#include "formats/hdf5/complex_modes_file.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/mbdyn/fem_file.hpp"
#include "formats/sid/sid.hpp"

namespace bough::analysis {

bool is_body_format(const std::string& format) { return format == "sid" || format == "mbdyn" || format == "flat"; }

std::string make_body_text(const std::string& file, const std::string& format, const BodyExportOptions& o,
                           Diagnostics& diagnostics) {
  if (read_file_format(file) != "bough-flexbody") refuse_export(file, format, "a flexible body, from bough reduce");
  const auto body = read_moving_body(file, diagnostics);
  if (format == "flat") return flat::format_flex_body(body);
  warn_of_third_order(body, file, format == "sid" ? "Standard Input Data" : "a .fem file", diagnostics);
  if (format == "mbdyn") return mbdyn::make_fem(body, {file}, diagnostics);
  sid::Layout layout;
  layout.is_full_inertia = o.inertia == "3x3";
  layout.by_component = o.ge_order == "component";
  layout.digits = o.digits;
  return sid::write_sid(sid::make_sid(body, layout, {file}, diagnostics), layout);
}

bool has_shapes(const std::string& format) {
  return format == "bough-flexbody" || format == "bough-modes" || format == "bough-complex-modes";
}

std::vector<exports::CsvColumn> read_shape_columns(const std::string& file, const std::string& format,
                                                   Diagnostics& diagnostics) {
  static constexpr const char* kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};
  const auto make = [](const std::vector<int>& id, const Eigen::MatrixXd& xyz, Eigen::Index num_modes,
                       const std::vector<std::string>& parts, const auto& get_value) {
    const auto p = static_cast<Eigen::Index>(id.size());
    std::vector<exports::CsvColumn> columns{{"id", Eigen::Map<const Eigen::VectorXi>(id.data(), p).cast<double>()}};
    for (int a = 0; a < 3 && p > 0; ++a) columns.push_back({kDirections[a], xyz.col(a)});
    for (Eigen::Index j = 0; p > 0 && j < num_modes; ++j)
      for (int d = 0; d < 6; ++d)
        for (const auto& part : parts) {
          columns.push_back({fmt::format("mode_{:03}_{}{}", j + 1, kDirections[d], part), Eigen::VectorXd(p)});
          for (Eigen::Index k = 0; k < p; ++k)
            columns.back().values[k] = get_value(static_cast<std::size_t>(k), d, j, part);
        }
    return columns;
  };
  const auto make_real = [&](const std::vector<int>& id, const Eigen::MatrixXd& xyz,
                             const std::vector<Eigen::MatrixXd>& phi) {
    return make(id, xyz, phi.empty() ? 0 : phi[0].cols(), {""},
                [&](std::size_t k, int d, Eigen::Index j, const std::string&) { return phi[k](d, j); });
  };
  if (format == "bough-complex-modes") {
    const auto modes = hdf5::read_complex_modes(file);
    return make(modes.node_id, modes.node_xyz, modes.eigenvalue.size(), {"_real", "_imag"},
                [&](std::size_t k, int d, Eigen::Index j, const std::string& part) {
                  const auto value = modes.phi[k](d, j);
                  return part == "_real" ? value.real() : value.imag();
                });
  }
  if (format == "bough-modes") {
    const auto modes = hdf5::read_modes(file);
    return make_real(modes.node_id, modes.node_xyz, modes.phi);
  }
  const auto body = read_body(file, diagnostics);
  return make_real(body.node_id, body.node_xyz, body.phi);
}

std::vector<exports::CsvColumn> read_mode_columns(const std::string& file, const std::string& format,
                                                  Diagnostics& diagnostics) {
  std::vector<exports::CsvColumn> columns;
  const auto make = [&](const Eigen::VectorXd& hz, const Eigen::VectorXd& eigenvalue, const Eigen::VectorXd& mass,
                        const Eigen::MatrixXd& effective) {
    static constexpr const char* kDirections[] = {"x", "y", "z", "rx", "ry", "rz"};
    columns = {{"mode", Eigen::VectorXd::LinSpaced(hz.size(), 1, static_cast<double>(hz.size()))},
               {"frequency_hz", hz},
               {"eigenvalue", eigenvalue},
               {"modal_mass", mass}};
    for (int d = 0; d < 6 && effective.rows() == hz.size(); ++d)
      columns.push_back({std::string("effective_mass_") + kDirections[d], effective.col(d)});
  };
  if (format == "bough-complex-modes") {
    const auto modes = hdf5::read_complex_modes(file);
    const auto n = modes.eigenvalue.size();
    return {{"mode", Eigen::VectorXd::LinSpaced(n, 1, static_cast<double>(n))},
            {"eigenvalue_real", modes.eigenvalue.real()},
            {"eigenvalue_imag", modes.eigenvalue.imag()},
            {"frequency_hz", modes.frequency_hz},
            {"damping", modes.damping},
            {"damping_ratio", modes.damping_ratio},
            {"residual", modes.residual}};
  }
  if (format == "bough-modes") {
    const auto modes = hdf5::read_modes(file);
    if (modes.load_factor.size() > 0)
      return {{"mode",
               Eigen::VectorXd::LinSpaced(modes.load_factor.size(), 1, static_cast<double>(modes.load_factor.size()))},
              {"load_factor", modes.load_factor}};
    make(modes.frequency_hz, modes.eigenvalue, modes.modal_mass, modes.effective_mass);
  } else {
    const auto body = read_body(file, diagnostics);
    make(body.frequency_hz, body.eigenvalue, body.modal_mass.diagonal(), body.effective_mass);
  }
  return columns;
}

}  // namespace bough::analysis
