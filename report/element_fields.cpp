#include "report/element_fields.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <unordered_map>

namespace bough::report {

namespace {

using Eigen::Index;
using records::ElementStresses;
using records::StaticSubcase;

struct Component {
  std::string base, point;  ///< "xx@top": xx, top
};

Component split(const std::string& component) {
  const auto at = component.find('@');
  return at == std::string::npos ? Component{component, {}}
                                 : Component{component.substr(0, at), component.substr(at + 1)};
}

/// "ply3" -> "ply 3", "C_a" -> "C, end a".
std::string name_point(const std::string& point) {
  for (const std::string word : {"ply", "bond"})
    if (point.starts_with(word) && point.size() > word.size()) return word + " " + point.substr(word.size());
  if (point.ends_with("_a") || point.ends_with("_b"))
    return point.substr(0, point.size() - 2) + ", end " + point.substr(point.size() - 1);
  return point;
}

/// Scalars and extremes first, then principal values, failure by ply, the components.
int get_rank(const std::string& component) {
  static constexpr std::array<const char*, 6> kDerived{"von_mises", "failure", "major", "minor", "max", "min"};
  const auto [base, point] = split(component);
  const auto found = std::find(kDerived.begin(), kDerived.end(), base);
  const int derived = static_cast<int>(found - kDerived.begin());
  return (point.empty() ? 0 : 10) + derived;
}

/// Values of neighbours have one meaning: invariants, and components of solids, which are in basic axes.
bool has_common_axes(const std::string& component) {
  const auto base = split(component).base;
  return base == "von_mises" || base == "failure" || base == "major" || base == "minor" ||
         component.find('@') == std::string::npos;
}

bool is_rod(const std::string& card) {
  return card.starts_with("CROD") || card.starts_with("CONROD") || card.starts_with("CTUBE");
}

/// A column of one or several cards, by element.
struct Column {
  std::string name, group, unit;
  bool has_average = false;
  std::map<std::uint32_t, std::vector<double>> rows;  ///< element -> a value per shape
};

class Collector {
 public:
  Collector(const records::StaticResult& result, Drawing& drawing) : result_(result), drawing_(drawing) {
    const auto& elements = drawing.elements;
    for (std::size_t k = 0; k < elements.id.size(); ++k) index_of_[elements.id[k]] = static_cast<std::uint32_t>(k);
    is_seen_.assign(elements.id.size(), false);
    for (const auto* list : {&elements.of_triangle, &elements.of_edge})
      for (const auto k : *list)
        if (k != DrawnElements::kNone) is_seen_[k] = true;
    for (std::size_t i = 1; i < elements.at_point.size(); i += 2) is_seen_[elements.at_point[i]] = true;
    drawing.property.assign(elements.id.size(), 0);
  }

  void add_blocks(const std::vector<ElementStresses> StaticSubcase::*blocks, const std::string& quantity) {
    for (std::size_t c = 0; c < drawing_.shapes.size(); ++c)
      for (const auto& block : result_.subcases[c].*blocks) {
        const auto elements = find_elements(block.id);
        for (std::size_t e = 0; e < block.id.size() && e < block.property.size(); ++e)
          if (elements[e] != DrawnElements::kNone)
            drawing_.property[elements[e]] = static_cast<std::uint32_t>(block.property[e]);
        for (std::size_t k = 0; k < block.components.size(); ++k) {
          auto component = block.components[k];
          // Solids have xx too, in basic axes.
          if (component == "xx" && is_rod(block.card)) component = "axial";
          auto& column = get_column(quantity, get_rank(component), component);
          column.name = name_field(component, quantity);
          column.group = quantity;
          const bool is_index = split(component).base == "failure";
          column.unit = is_index || quantity == "strain" ? "" : "F/L^2";
          if (split(component).base.starts_with("kappa")) column.unit = "1/L";
          column.has_average = has_common_axes(component);
          add_values(elements, block.stress.col(static_cast<Index>(k)), c, column);
        }
      }
  }

  void add_margins() {
    static constexpr std::array<const char*, 3> kNames{"tension", "compression", "shear"};
    for (std::size_t c = 0; c < drawing_.shapes.size(); ++c)
      for (const auto& block : result_.subcases[c].margins) {
        const auto elements = find_elements(block.id);
        for (std::size_t k = 0; k < kNames.size() && static_cast<Index>(k) < block.margin.cols(); ++k) {
          if (!block.margin.col(static_cast<Index>(k)).array().isFinite().any()) continue;
          auto& column = get_column("margin of safety", static_cast<int>(k), kNames[k]);
          column.name = std::string("margin of safety, ") + kNames[k];
          column.group = "margin of safety";
          add_values(elements, block.margin.col(static_cast<Index>(k)), c, column);
        }
      }
  }

  int finish(std::size_t max_values) {
    std::size_t count = 0;
    int num_dropped = 0;
    for (const auto& [unused, column] : columns_) {
      if (column.rows.empty()) continue;
      const std::size_t size = column.rows.size() * drawing_.shapes.size();
      if (count + size > max_values) {
        ++num_dropped;
        continue;
      }
      count += size;
      ElementField field{column.name, column.group, column.unit, column.has_average, {}, {}};
      field.values.assign(drawing_.shapes.size(), Eigen::VectorXd(static_cast<Index>(column.rows.size())));
      Index row = 0;
      for (const auto& [element, values] : column.rows) {
        field.element.push_back(element);
        for (std::size_t c = 0; c < values.size(); ++c) field.values[c][row] = values[c];
        ++row;
      }
      drawing_.fields.push_back(std::move(field));
    }
    return num_dropped;
  }

 private:
  /// Index of each element among the drawn ones, kNone for those that no one sees.
  std::vector<std::uint32_t> find_elements(const std::vector<int>& ids) const {
    std::vector<std::uint32_t> elements;
    for (const int id : ids) {
      const auto found = index_of_.find(id);
      elements.push_back(found != index_of_.end() && is_seen_[found->second] ? found->second : DrawnElements::kNone);
    }
    return elements;
  }

  /// Columns in the order of their ranks, else in that of the file.
  Column& get_column(const std::string& group, int rank, const std::string& component) {
    static const std::map<std::string, int> kGroups{{"stress", 0}, {"margin of safety", 1}, {"strain", 2}};
    const auto [order, unused] = order_.try_emplace(group + " " + component, static_cast<int>(order_.size()));
    return columns_[{rank >= 16 ? 1 : 0, kGroups.at(group), rank, order->second}];
  }

  void add_values(const std::vector<std::uint32_t>& elements, const Eigen::VectorXd& values, std::size_t shape,
                  Column& column) const {
    for (std::size_t e = 0; e < elements.size(); ++e) {
      if (elements[e] == DrawnElements::kNone) continue;
      auto& row = column.rows[elements[e]];
      row.resize(drawing_.shapes.size(), std::numeric_limits<double>::quiet_NaN());
      row[shape] = values[static_cast<Index>(e)];
    }
  }

  const records::StaticResult& result_;
  Drawing& drawing_;
  std::unordered_map<int, std::uint32_t> index_of_;
  std::vector<bool> is_seen_;
  std::map<std::string, int> order_;
  std::map<std::tuple<int, int, int, int>, Column> columns_;
};

}  // namespace

std::string name_field(const std::string& component, const std::string& quantity) {
  static const std::map<std::string, std::string> kNames{{"von_mises", "von Mises"},
                                                         {"major", "largest principal"},
                                                         {"minor", "smallest principal"},
                                                         {"max", "largest axial"},
                                                         {"min", "smallest axial"}};
  const auto [base, point] = split(component);
  const auto found = kNames.find(base);
  std::string name = quantity + " " + base;
  if (found != kNames.end()) name = found->second + " " + quantity;
  if (base == "axial") name = "axial " + quantity;
  if (base == "failure") name = "failure index";
  if (base.starts_with("kappa_")) name = "curvature " + base.substr(6);
  return point.empty() ? name : name + ", " + name_point(point);
}

int add_fields(const records::StaticResult& result, Drawing& drawing, std::size_t max_values) {
  if (drawing.shapes.empty() || drawing.elements.id.empty()) return 0;
  Collector collector(result, drawing);
  collector.add_blocks(&StaticSubcase::stresses, "stress");
  collector.add_margins();
  collector.add_blocks(&StaticSubcase::strains, "strain");
  return collector.finish(max_values);
}

}  // namespace bough::report
