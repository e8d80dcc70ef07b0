// Flexible bodies and modes: views of the records' own arrays.
#include <filesystem>

#include <pybind11/stl/filesystem.h>

#include "python/bindings/bindings.hpp"

#include "analysis/common/body_files.hpp"
#include "cli/common/options.hpp"
#include "formats/hdf5/files.hpp"
#include "formats/records/mode_kind.hpp"

namespace bough::python {

namespace {

using records::FlexBody;
using records::MassIntegrals;
using records::ModesResult;

std::vector<std::string> get_words(const std::vector<records::ModeKind>& kinds) {
  std::vector<std::string> words;
  for (const auto kind : kinds) words.emplace_back(records::get_name(kind));
  return words;
}

/// A property that shows a matrix of the record.
template <class Record, class Member>
auto show(Member Record::*member) {
  return [member](py::object self) { return view(self.cast<Record&>().*member, self); };
}
template <class Record, class Member>
auto show_all(Member Record::*member) {
  return [member](py::object self) { return view_all(self.cast<Record&>().*member, self); };
}

void bind_flex_body(py::module_& m) {
  py::class_<MassIntegrals>(m, "MassIntegrals", "The five mass integrals; column j belongs to mode j.")
      .def_property_readonly("gamma0", show(&MassIntegrals::gamma0), "3 x n")
      .def_property_readonly("gamma1", show(&MassIntegrals::gamma1), "3 x n")
      .def_property_readonly("gamma2", show_all(&MassIntegrals::gamma2), "[j] 3 x n")
      .def_property_readonly("gamma3", show_all(&MassIntegrals::gamma3), "[j] 3 x 3")
      .def_property_readonly(
          "gamma4",
          [](py::object self) {
            py::list rows;
            for (const auto& row : self.cast<MassIntegrals&>().gamma4) rows.append(view_all(row, self));
            return rows;
          },
          "[j][k] 3 x 3")
      .def("__bool__", [](const MassIntegrals& i) { return !i.empty(); });

  py::class_<records::Locator>(m, "Locator", "A unit load whose geometric stiffness the body has.")
      .def_readonly("name", &records::Locator::name)
      .def_readonly("node", &records::Locator::node)
      .def_readonly("direction", &records::Locator::direction);

  py::class_<FlexBody>(m, "FlexBody", "A reduced flexible body; its arrays are views, nothing is copied.")
      .def_readwrite("name", &FlexBody::name)
      .def_readonly("source", &FlexBody::source)
      .def_readwrite("mass", &FlexBody::mass)
      .def_property_readonly("cg", show(&FlexBody::cg))
      .def_property_readonly("inertia", show(&FlexBody::inertia), "3 x 3, about the body origin")
      .def_readonly("node_id", &FlexBody::node_id)
      .def_property_readonly("node_xyz", show(&FlexBody::node_xyz), "p x 3")
      .def_readonly("interface_nodes", &FlexBody::interface_nodes)
      .def_readonly("is_free_free", &FlexBody::is_free_free)
      .def_property_readonly("frequency_hz", show(&FlexBody::frequency_hz))
      .def_property_readonly("eigenvalue", show(&FlexBody::eigenvalue))
      .def_property_readonly("kind", [](const FlexBody& b) { return get_words(b.kind); })
      .def_property_readonly("phi", show_all(&FlexBody::phi), "[node] 6 x n: translations, rotations")
      .def_property_readonly("modal_mass", show(&FlexBody::modal_mass))
      .def_property_readonly("modal_stiffness", show(&FlexBody::modal_stiffness))
      .def_property_readonly("modal_damping", show(&FlexBody::modal_damping))
      .def_property_readonly("effective_mass", show(&FlexBody::effective_mass), "n x 6")
      .def_property_readonly("lumped", [](FlexBody& b) -> MassIntegrals& { return b.lumped; })
      .def_property_readonly("consistent", [](FlexBody& b) -> MassIntegrals& { return b.consistent; })
      .def_property_readonly("exact", [](FlexBody& b) -> MassIntegrals& { return b.exact; })
      .def_readonly("integrals_method", &FlexBody::integrals_method)
      .def_property_readonly("integrals",
                             [](FlexBody& b) -> MassIntegrals& {
                               return b.integrals_method == "exact"        ? b.exact
                                      : b.integrals_method == "consistent" ? b.consistent
                                                                           : b.lumped;
                             })
      .def_property_readonly("inertial_loads", show(&FlexBody::F_I), "ndof x 12")
      .def_property_readonly("dof_map", show(&FlexBody::dof_map), "ndof x 2: node, code")
      .def_property_readonly("kg_inertial", show_all(&FlexBody::kg_inertial), "[load] n x n, 12 of them")
      .def_readonly("kg_inertial_computed", &FlexBody::kg_inertial_computed)
      .def_readonly("locators", &FlexBody::locators)
      .def_property_readonly("kg_external", show_all(&FlexBody::kg_external), "[locator] n x n")
      .def_property_readonly("external_load", show(&FlexBody::external_load), "n x locators")
      .def_readonly("preload", &FlexBody::preload)
      .def_property_readonly("kg_preload", show(&FlexBody::kg_preload))
      .def_property_readonly("full_phi", show(&FlexBody::full_phi), "ndof x n, with full=True")
      .def_property_readonly("num_modes", &FlexBody::num_modes)
      .def_property_readonly("num_nodes", &FlexBody::num_nodes)
      .def("copy", [](const FlexBody& b) { return FlexBody(b); })
      .def("save", make_save<FlexBody>(&hdf5::write_flex_body), py::arg("path"), OneAtATime(),
           "Write the flexible-body HDF5 file.")
      .def("__repr__", [](const FlexBody& b) {
        return "<FlexBody '" + b.name + "': " + std::to_string(b.num_modes()) + " modes, " +
               std::to_string(b.num_nodes()) + " nodes>";
      });
}

}  // namespace

void demand_no_source(const std::string& path, const std::vector<std::pair<std::string, std::string>>& source) {
  std::error_code failed;
  if (!std::filesystem::is_regular_file(path, failed)) return;
  const auto name = std::filesystem::canonical(path, failed).filename().string();
  for (const auto& [input, hash] : source)
    if (input == name && hash == hdf5::calc_sha256(path))
      throw InputError("cli.output-is-input", {path}, "the output would overwrite the input file " + input,
                       "choose another file");
}

void bind_bodies(py::module_& m) {
  bind_flex_body(m);
  py::class_<ModesResult>(m, "Modes", "Normal modes or load factors of a deck.")
      .def_readonly("subcase", &ModesResult::subcase)
      .def_readonly("node_id", &ModesResult::node_id)
      .def_property_readonly("node_xyz", show(&ModesResult::node_xyz))
      .def_property_readonly("eigenvalue", show(&ModesResult::eigenvalue))
      .def_property_readonly("frequency_hz", show(&ModesResult::frequency_hz))
      .def_property_readonly("load_factor", show(&ModesResult::load_factor), "buckling")
      .def_property_readonly("residual", show(&ModesResult::residual))
      .def_property_readonly("phi", show_all(&ModesResult::phi), "[node] 6 x n")
      .def_property_readonly("modal_mass", show(&ModesResult::modal_mass))
      .def_property_readonly("effective_mass", show(&ModesResult::effective_mass), "n x 6")
      .def_property_readonly("mass", [](const ModesResult& r) { return r.mass_properties.mass; })
      .def_property_readonly("cg", [](const ModesResult& r) { return give(Eigen::Vector3d(r.mass_properties.cg)); })
      .def_property_readonly("inertia",
                             [](const ModesResult& r) { return give(Eigen::Matrix3d(r.mass_properties.inertia)); })
      .def_readonly("num_rigid_modes", &ModesResult::num_rigid_modes);
  m.def(
      "read_flex_body",
      [](const std::filesystem::path& path) {
        Diagnostics notes;  // of data that a .FLX does not contain: docs/formats/flx.md
        return analysis::read_body(path, notes);
      },
      py::arg("path"), OneAtATime());
  m.def(
      "read_modes", [](const std::filesystem::path& path) { return hdf5::read_modes(path); }, py::arg("path"),
      OneAtATime());
}

}  // namespace bough::python
