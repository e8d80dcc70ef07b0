#include <algorithm>
#include <charconv>

#include "base/version.hpp"
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {
namespace {

using records::ElementForces;
using records::ElementStresses;

std::vector<std::string> read_components(FileReader& file, const std::string& group, long count) {
  auto words = file.read_attribute_words(group, "components");
  if (static_cast<long>(words.size()) != count)
    file.error("hdf5.shape",
               group + " has " + std::to_string(count) + " columns and names " + std::to_string(words.size()),
               "write the file again");
  words.resize(static_cast<std::size_t>(count));
  return words;
}

/// Blocks of elements by card, whose numbers read_values(block, group, number of elements) reads.
template <class Block, class ReadValues>
std::vector<Block> read_blocks(FileReader& file, const std::string& path, const ReadValues& read_values) {
  std::vector<Block> blocks;
  for (const auto& card : file.get_children(path)) {
    const auto group = path + "/" + card;
    Block block;
    block.card = card;
    block.id = file.read_integers(group + "/id");
    const auto count = static_cast<long>(block.id.size());
    block.property = file.read_integers(group + "/property");
    const auto num_columns = read_values(block, group, count);
    block.components = read_components(file, group, num_columns);
    blocks.push_back(std::move(block));
  }
  return blocks;
}

std::vector<ElementForces> read_forces(FileReader& file, const std::string& path) {
  return read_blocks<ElementForces>(file, path, [&](ElementForces& block, const std::string& group, long) {
    block.force = file.read_matrix(group + "/force");
    block.strain_energy = file.read_vector(group + "/strain_energy");
    return block.force.cols();
  });
}

std::vector<ElementStresses> read_stresses(FileReader& file, const std::string& path, const std::string& quantity) {
  return read_blocks<ElementStresses>(file, path, [&](ElementStresses& block, const std::string& group, long count) {
    block.stress = to_matrix(file.read_array(group + "/" + quantity, {count, -1}, true));
    return block.stress.cols();
  });
}

void read_support(FileReader& file, const std::string& path, records::StaticSubcase& s) {
  const auto group = path + "/support";
  if (!file.has(group)) return;
  const auto dofs = file.read_integer_matrix(group + "/dofs");
  const auto energy = file.read_vector(group + "/strain_energy");
  const bool has_inertia = file.has(group + "/acceleration");
  const auto acceleration =
      has_inertia ? file.read_vector(group + "/acceleration") : Eigen::VectorXd(Eigen::VectorXd::Zero(dofs.rows()));
  for (Eigen::Index i = 0; i < dofs.rows(); ++i)
    s.support.push_back({dofs(i, 0), dofs(i, 1), energy[i], acceleration[i]});
  s.support_epsilon = file.read_number(group + "/epsilon");
}

records::StaticSubcase read_subcase(FileReader& file, const std::string& name) {
  const auto path = "/subcases/" + name;
  records::StaticSubcase s;
  const auto end = name.data() + name.size();
  if (const auto [to, error] = std::from_chars(name.data(), end, s.id); error != std::errc() || to != end)
    file.error("hdf5.value", path + " is not named by the number of a subcase", "write the file again");
  s.label = file.read_attribute(path, "label");
  s.load_set = file.read_integer_attribute(path, "load_set", 0);
  s.temperature_set = file.read_integer_attribute(path, "temperature_set", 0);
  s.spc_set = file.read_integer_attribute(path, "spc_set", 0);
  s.mpc_set = file.read_integer_attribute(path, "mpc_set", 0);
  s.displacement = file.read_vector(path + "/displacement");
  s.load = file.read_vector(path + "/load");
  s.reaction = file.read_vector(path + "/reaction");
  s.mpc_force = file.read_vector(path + "/mpc_force");
  s.strain_energy = file.read_number(path + "/strain_energy");
  s.epsilon = file.read_number(path + "/epsilon");
  const auto resultants = file.read_matrix(path + "/resultants");
  s.load_resultant = resultants.row(0);
  s.reaction_resultant = resultants.row(1);
  s.mpc_resultant = resultants.row(2);
  read_support(file, path, s);
  if (file.has(path + "/inertia")) s.inertia = file.read_vector(path + "/inertia");
  s.elements = read_forces(file, path + "/elements");
  s.stresses = read_stresses(file, path + "/stresses", "stress");
  s.strains = read_stresses(file, path + "/strains", "strain");
  for (const auto& card : file.get_children(path + "/margins")) {
    const auto group = path + "/margins/" + card;
    records::StressMargins block;
    block.card = card;
    block.id = file.read_integers(group + "/id");
    block.margin = to_matrix(file.read_array(group + "/margin", {static_cast<long>(block.id.size()), 3}, true));
    s.margins.push_back(std::move(block));
  }
  return s;
}

}  // namespace

records::StaticResult read_static(const std::string& path) {
  FileReader file(path, "bough-static", kStaticFormatVersion);
  records::StaticResult result;
  result.source = file.read_source();
  result.dof_map = file.read_integer_matrix("/dof_map");
  result.mesh = read_mesh(file);
  for (const auto& name : file.get_children("/subcases")) result.subcases.push_back(read_subcase(file, name));
  file.throw_if_errors();
  std::sort(result.subcases.begin(), result.subcases.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return result;
}

}  // namespace bough::hdf5
