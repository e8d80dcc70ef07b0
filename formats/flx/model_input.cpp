#include "formats/flx/model_input.hpp"

#include <fmt/format.h>

#include <set>

#include "formats/flx/list_directed.hpp"

namespace bough::flx {

namespace {

/// The items of MODEL.inp in their order; numbers are the same whether an optional one is there or not.
enum Item {
  Sizes = 1,
  DofMap,
  Offset,
  Coordinates,
  BodyId,
  IntegralOption,
  BodyMass,
  DampingOption,
  DampingRatio,
  NumModes,
  SelectionFlag,
  Selection,
  NumNodes,
  Nodes,
  SpecialNodes
};
constexpr int kNumItems = SpecialNodes;

std::string name(Item item) {
  static const char* const names[kNumItems] = {"sizes (nodes, dofs, modes)",
                                               "degree-of-freedom map",
                                               "offset vector",
                                               "node coordinates",
                                               "body id",
                                               "modal integral option",
                                               "body mass",
                                               "damping option",
                                               "damping ratio",
                                               "number of modes",
                                               "mode selection flag",
                                               "mode selection",
                                               "number of output nodes",
                                               "output nodes",
                                               "special node option"};
  return fmt::format("item {} of {}: {}", static_cast<int>(item), kNumItems, names[item - 1]);
}

class ModelInputReader {
 public:
  ModelInputReader(const std::string& path, Diagnostics& diagnostics)
      : diagnostics_(diagnostics), in_(ListReader::open(path, diagnostics)) {}

  ModelInput read() {
    // Every step gives false if nothing after it can be found.
    if (read_sizes() && read_dof_map() && read_geometry() && read_body() && read_damping() && read_modes() &&
        read_nodes() && read_special_nodes())
      in_.check_end();
    return std::move(model_);
  }

 private:
  void error(const char* id, Item item, const std::string& what, const std::string& advice) {
    diagnostics_.error(id, in_.get_location(), name(item) + ": " + what, advice);
  }

  template <class Number>
  bool read_one(Item item, Number& value) {
    std::vector<Number> one(1);
    if (!in_.read(name(item), one)) return false;
    value = one[0];
    return true;
  }

  bool read_option(Item item, int min_value, int max_value, int& value) {
    if (!read_one(item, value)) return false;
    if (value < min_value || value > max_value) {
      error("flx.bad-option", item, fmt::format("found {}, expected {} to {}", value, min_value, max_value),
            "see docs/formats/flx.md");
    }
    return true;
  }

  bool read_sizes() {
    std::vector<int> sizes(3);
    if (!in_.read(name(Sizes), sizes)) return false;
    model_.num_nodes = sizes[0];
    model_.num_dofs = sizes[1];
    model_.num_modes_given = sizes[2];
    const bool is_valid = sizes[0] >= 1 && sizes[1] >= 1 && sizes[2] >= 1 && sizes[2] <= sizes[1];
    if (!is_valid) {
      error("flx.wrong-size", Sizes, fmt::format("found {} {} {}", sizes[0], sizes[1], sizes[2]),
            "give at least one node, one dof and one mode, and no more modes than dofs");
    }
    return is_valid;
  }

  bool read_dof_map() {
    std::vector<int> pair(2);
    std::vector<std::pair<int, int>> rows;
    std::set<std::pair<int, int>> seen;
    for (int i = 1; i <= model_.num_dofs; ++i) {
      if (!in_.read(fmt::format("{}, entry {} of {}", name(DofMap), i, model_.num_dofs), pair)) return false;
      const auto [node, code] = std::pair(pair[0], pair[1]);
      rows.emplace_back(node, code);
      if (code < 1 || code > kGeneralizedDof) {
        error("flx.bad-dof", DofMap, fmt::format("entry {} has the type {}, expected 1 to 7", i, code),
              "1 2 3 are translations x y z, 4 5 6 rotations, 7 a generalized coordinate");
      } else if (code != kGeneralizedDof) {
        if (node < 1 || node > model_.num_nodes) {
          error("flx.unknown-node", DofMap,
                fmt::format("entry {} is at node {}, the model has 1 to {}", i, node, model_.num_nodes),
                "number the nodes in the order of their coordinates");
        } else if (!seen.emplace(node, code).second) {
          error("flx.duplicate-dof", DofMap, fmt::format("entry {} is node {} type {} again", i, node, code),
                "list each degree of freedom once");
        }
      }
    }
    model_.dof_map.resize(model_.num_dofs, 2);
    for (int i = 0; i < model_.num_dofs; ++i) model_.dof_map.row(i) << rows[i].first, rows[i].second;
    return true;
  }

  bool read_geometry() {
    std::vector<double> xyz(3);
    if (!in_.read(name(Offset), xyz)) return false;
    model_.offset = Eigen::Map<Eigen::Vector3d>(xyz.data());
    std::vector<double> all;
    for (int i = 1; i <= model_.num_nodes; ++i) {
      if (!in_.read(fmt::format("{}, node {} of {}", name(Coordinates), i, model_.num_nodes), xyz)) return false;
      all.insert(all.end(), xyz.begin(), xyz.end());
    }
    model_.xyz = Eigen::Map<Eigen::MatrixXd>(all.data(), 3, model_.num_nodes).transpose();
    return true;
  }

  bool read_body() {
    if (!read_one(BodyId, model_.body_id) || !read_option(IntegralOption, 0, 2, model_.modopt) ||
        !read_one(BodyMass, model_.mass))
      return false;
    if (model_.mass <= 0)
      error("flx.bad-value", BodyMass, fmt::format("found {}, expected more than zero", model_.mass),
            "give the mass of the whole body: the first integral is divided by it");
    return true;
  }

  bool read_damping() {
    if (!read_option(DampingOption, 1, 2, model_.damping_option)) return false;
    if (model_.damping_option != 2) return model_.damping_option == 1;
    if (!read_one(DampingRatio, model_.zeta)) return false;
    if (model_.zeta < 0)
      error("flx.bad-value", DampingRatio, fmt::format("found {}, expected zero or more", model_.zeta),
            "give the ratio to critical damping, such as 0.005");
    return true;
  }

  /// A count that the lines after it are read by: nothing can follow a bad one.
  bool read_count(Item item, int max_value, const char* id, const std::string& what, int& count) {
    if (!read_one(item, count)) return false;
    if (count >= 0 && count <= max_value && (count > 0 || item == NumNodes)) return true;
    error(id, item, fmt::format("found {}, {} {}", count, what, max_value), "correct the number, or the first line");
    return false;
  }

  /// A list of numbers in ascending order: its item, what it numbers, and the numbers there are.
  struct Listed {
    Item item;
    const char *noun, *range;
    int max;
  };
  struct ListErrors {
    const char *range_id, *range_advice, *order_id, *order_advice;
  };
  bool read_ascending(const Listed& list, int count, const ListErrors& errors, std::vector<int>& numbers) {
    int last = 0;
    for (int entry = 1; entry <= count; ++entry) {
      std::vector<int> one(1);
      if (!in_.read(fmt::format("{}, entry {} of {}", name(list.item), entry, count), one)) return false;
      const int number = one[0];
      if (number < 1 || number > list.max)
        error(errors.range_id, list.item,
              fmt::format("entry {} is {} {}, {} 1 to {}", entry, list.noun, number, list.range, list.max),
              errors.range_advice);
      else if (number <= last)
        error(errors.order_id, list.item,
              fmt::format("entry {} is {} {} after {} {}", entry, list.noun, number, list.noun, last),
              errors.order_advice);
      last = number;
      numbers.push_back(number);
    }
    return true;
  }

  bool read_modes() {
    int count = 0, flag = 0;
    if (!read_count(NumModes, model_.num_modes_given, "flx.too-many-modes", "the modes given are", count)) return false;
    if (!read_option(SelectionFlag, 1, 2, flag)) return false;
    if (flag != 1 && flag != 2) return false;
    if (flag == 2)
      return read_ascending({Selection, "mode", "the modes given are", model_.num_modes_given}, count,
                            {"flx.bad-selection", "choose among the modes that the first line counts",
                             "flx.bad-selection", "list each mode once, in ascending order"},
                            model_.modes);
    for (int mode = 1; mode <= count; ++mode) model_.modes.push_back(mode);
    return true;
  }

  bool read_nodes() {
    int count = 0;
    return read_count(NumNodes, model_.num_nodes, "flx.too-many-nodes", "the nodes given are", count) &&
           read_ascending({Nodes, "node", "the model has", model_.num_nodes}, count,
                          {"flx.unknown-node", "number the nodes in the order of their coordinates", "flx.node-order",
                           "list each node once, in ascending order"},
                          model_.nodes);
  }

  bool read_special_nodes() {
    int option = 0;
    if (!read_option(SpecialNodes, 1, 2, option)) return false;
    model_.has_special_nodes = option == 2;
    return true;
  }

  Diagnostics& diagnostics_;
  ListReader in_;
  ModelInput model_;
};

/// A square matrix, one row a read.
bool read_square(ListReader& in, const std::string& item, int size, SparseMatrix& matrix) {
  std::vector<double> row(static_cast<std::size_t>(size));
  matrix.resize(size, size);
  for (int i = 0; i < size; ++i) {
    if (!in.read(fmt::format("{}, row {} of {}", item, i + 1, size), row)) return false;
    matrix.startVec(i);
    for (int j = 0; j < size; ++j)
      if (row[j] != 0) matrix.insertBack(i, j) = row[j];
  }
  matrix.finalize();
  return true;
}

void check_symmetry(const SparseMatrix& matrix, const std::string& item, const std::string& path,
                    Diagnostics& diagnostics) {
  const SparseMatrix transpose = matrix.transpose();
  const double part = (matrix - transpose).norm() / std::max(matrix.norm(), 1e-300);
  if (part > 1e-8)
    diagnostics.warning("flx.unsymmetric", {path},
                        fmt::format("{} is not symmetric: |A - A'| is {:.1e} of |A|", item, part),
                        "check its rows; it is used unchanged");
}

}  // namespace

ModelInput read_model_input(const std::string& path, Diagnostics& diagnostics) {
  return ModelInputReader(path, diagnostics).read();
}

ModelMatrices read_model_matrices(const std::string& path, const ModelInput& model, Diagnostics& diagnostics) {
  auto in = ListReader::open(path, diagnostics);
  ModelMatrices matrices;
  const bool has_damping = model.damping_option == 1;
  const int num_items = has_damping ? 4 : 3;
  int number = 0;
  const auto next_item = [&](const char* what) { return fmt::format("item {} of {}: {}", ++number, num_items, what); };
  const auto read_next = [&](const char* what, SparseMatrix& matrix) {
    const std::string item = next_item(what);
    if (!read_square(in, item, model.num_dofs, matrix)) return false;
    check_symmetry(matrix, item, path, diagnostics);
    return true;
  };
  if (!read_next("mass matrix", matrices.M) || !read_next("stiffness matrix", matrices.K)) return matrices;
  if (has_damping && !read_next("damping matrix", matrices.D)) return matrices;
  const std::string item = next_item("mode shapes");
  std::vector<double> row(static_cast<std::size_t>(model.num_modes_given));
  matrices.Phi.resize(model.num_dofs, model.num_modes_given);
  for (int i = 0; i < model.num_dofs; ++i) {
    if (!in.read(fmt::format("{}, row {} of {}", item, i + 1, model.num_dofs), row)) return matrices;
    for (int j = 0; j < model.num_modes_given; ++j) matrices.Phi(i, j) = row[static_cast<std::size_t>(j)];
  }
  in.check_end();
  return matrices;
}

}  // namespace bough::flx
