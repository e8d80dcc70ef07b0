#include "analysis/export/export_matrices.hpp"

#include <algorithm>

#include "analysis/common/body_files.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::analysis {

void refuse_export(const std::string& file, const std::string& format, const std::string& expected) {
  throw InputError("cli.no-export", {file},
                   "a file of format \"" + read_file_format(file) + "\" has no export to " + format,
                   "give " + expected);
}

std::vector<std::pair<std::string, const records::MassIntegrals*>> list_integrals(const records::FlexBody& body) {
  std::vector<std::pair<std::string, const records::MassIntegrals*>> found;
  for (const auto& [name, set] : {std::pair<std::string, const records::MassIntegrals*>{"lumped", &body.lumped},
                                  {"consistent", &body.consistent},
                                  {"exact", &body.exact}})
    if (!set->empty()) found.emplace_back(name, set);
  return found;
}

std::optional<exports::ReducedSolid> find_solid(const records::FlexBody& body, const std::string& file,
                                                Diagnostics& diagnostics) {
  if (std::find(body.kind.begin(), body.kind.end(), records::ModeKind::Constraint) == body.kind.end()) return {};
  std::string why;
  auto solid = exports::calc_reduced_solid(body, why);
  if (!solid)
    diagnostics.warning("export.no-frames", {file}, "P, K, M on the interface frames are left out: " + why,
                        "reduce with the interface nodes that the constraint modes belong to");
  return solid;
}

}  // namespace bough::analysis
