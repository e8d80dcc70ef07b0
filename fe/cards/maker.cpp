#include "fe/cards/maker.hpp"

#include <algorithm>

#include "base/number_text.hpp"

namespace bough::fe {

int Maker::find_point(int grid, const std::string& who, const records::CardLocation& at) {
  const int index = nodes_.find_node(grid);
  if (index < 0 && !nodes_.is_refused(grid))
    error("fe.missing-grid", at, who + " refers to grid " + std::to_string(grid) + ", which the deck does not define",
          "add the GRID or correct the id");
  return index;
}

int Maker::find_grid(int grid, const std::string& who, const records::CardLocation& at) {
  const int index = find_point(grid, who, at);
  if (index >= 0 && nodes_.node(index).num_dofs != 6) {
    error("fe.missing-grid", at,
          who + " needs a grid with six components, but " + std::to_string(grid) + " is a scalar point",
          "refer to a GRID");
    return -1;
  }
  return index;
}

const records::Mat1* Maker::find_material(int mid, const std::string& who, const records::CardLocation& at) {
  const records::Mat1* material = mat1_.find(mid);
  if (!material) {
    if (deck_.is_refused(mid, {"MAT1"})) return nullptr;
    error("fe.missing-material", at,
          who + " refers to MAT1 " + std::to_string(mid) + ", which the deck does not define",
          "add the MAT1 or correct the id");
    return nullptr;
  }
  if (const auto known = material_ok_.find(mid); known != material_ok_.end()) return known->second ? material : nullptr;
  const bool ok = material->E > 0 && material->G >= 0 && material->rho >= 0;
  material_ok_[mid] = ok;
  if (ok) return material;
  error("fe.bad-material", material->at,
        "MAT1 " + std::to_string(mid) + " has E = " + show_number(material->E) + ", G = " + show_number(material->G) +
            ", density = " + show_number(material->rho) + ", expected E > 0, G >= 0 and density >= 0",
        "correct the material");
  return nullptr;
}

void Maker::report_missing_property(int pid, const std::string& kinds, const std::string& who,
                                    const records::CardLocation& at) {
  for (std::size_t from = 0, to = 0; from < kinds.size(); from = to + 1) {
    to = std::min(kinds.find_first_of(" ,", from), kinds.size());
    if (deck_.is_refused(pid, {kinds.substr(from, to - from)})) return;
  }
  error("fe.missing-property", at,
        who + " refers to property " + std::to_string(pid) + ", but the deck has no " + kinds + " with that id",
        "add the property or correct the id");
}

std::vector<int> Maker::list_gdofs(const std::vector<int>& node_indices) const {
  std::vector<int> gdofs;
  for (int index : node_indices) {
    const Node& node = nodes_.node(index);
    for (int c = 0; c < node.num_dofs; ++c) gdofs.push_back(node.first_gdof + c);
  }
  return gdofs;
}

}  // namespace bough::fe
