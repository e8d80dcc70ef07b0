#include "formats/hdf5/detail/writer.hpp"
#include "formats/records/mode_kind.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "base/diagnostic.hpp"
#include "base/version.hpp"
#include "formats/hdf5/detail/dimension_scales.hpp"
#include "formats/hdf5/inspect.hpp"

namespace bough::hdf5 {

namespace {

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

Handle make_space(const Dims& shape) {
  if (shape.empty()) return {H5Screate(H5S_SCALAR), H5Sclose};
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}

bool has_elements(const Dims& shape) {
  for (const auto d : shape) {
    if (d == 0) return false;
  }
  return true;
}

}  // namespace

FileWriter::FileWriter(const std::string& path, const std::string& format, const std::string& version)
    : path_(path), part_(path) {
  errno = part_->error().value();
  check(!part_->error() && takes_a_block(part_->get_descriptor()), "the file cannot be created");
  open(part_->get_name().c_str(), make_file_access(), format, version);
}

FileWriter::FileWriter(const std::string& format, const std::string& version) : path_("memory") {
  const Handle access = make_file_access();
  H5Pset_fapl_core(access.get(), 1 << 20, false);
  open("memory", access, format, version);
}

void FileWriter::open(const char* name, const Handle& access, const std::string& format, const std::string& version) {
  // Creation times are left out, so that the same content gives the same bytes.
  Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  string_type_ = make_string_type();
  scalar_ = make_space({});
  creation_ = Handle(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation_.get(), false);
  group_creation_ = Handle(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(group_creation_.get(), false);
  link_creation_ = Handle(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(link_creation_.get(), 1);
  layout_ = find_layout(format);
  file_ = Handle(H5Fcreate(name, H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose);
  check(file_.is_valid(), "the file cannot be created");
  write_attribute("/", "format", format);
  write_attribute("/", "format_version", version);
  write_attribute("/", "bough_version", std::string(get_version()));
}

void FileWriter::check(bool ok, const std::string& what) {
  if (ok) return;
  if (file_.is_valid()) {
    const int cause = errno;
    abandon_writes(file_.get());
    errno = cause;
  }
  const std::string reason = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
  throw ComputationError("hdf5.write", {path_}, what + reason, "check the folder, its permissions and the free space");
}

void FileWriter::make_group(const std::string& path) {
  if (groups_.count(path) > 0) return;
  make_parents(path);
  Handle group(H5Gcreate2(file_.get(), path.c_str(), link_creation_.get(), group_creation_.get(), H5P_DEFAULT),
               H5Gclose);
  check(group.is_valid(), "group " + path + " cannot be written");
  groups_.emplace(path, std::move(group));
}

/// Parents are made here and not by the library, which would stamp them with the time.
void FileWriter::make_parents(const std::string& path) {
  for (std::size_t end = path.find('/', 1); end != std::string::npos; end = path.find('/', end + 1))
    make_group(path.substr(0, end));
}

hid_t FileWriter::find_parent(const std::string& path) {
  make_parents(path);
  const auto end = path.rfind('/');
  return end == 0 ? file_.get() : groups_.at(path.substr(0, end)).get();
}

void FileWriter::write(const std::string& path, const Dims& shape, hid_t file_type, const Put& put,
                       const ArrayAttributes& attributes) {
  errno = 0;
  const hid_t parent = find_parent(path);
  const Handle space = make_space(shape);
  {
    Handle dataset(H5Dcreate2(parent, path.c_str() + path.rfind('/') + 1, file_type, space.get(), H5P_DEFAULT,
                              creation_.get(), H5P_DEFAULT),
                   H5Dclose);
    check(dataset.is_valid(), "dataset " + path + " cannot be written");
    if (has_elements(shape)) check(put(dataset.get(), space.get()), "dataset " + path + " cannot be written");
    write_attributes(dataset.get(), path, attributes);
    check(dataset.reset(), "dataset " + path + " cannot be written");
  }
}

void FileWriter::write(const std::string& path, const Dims& shape, hid_t file_type, hid_t memory_type, const void* data,
                       const ArrayAttributes& attributes, hid_t transfer) {
  const auto put = [&](hid_t dataset, hid_t) {
    return H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, transfer, data) >= 0;
  };
  write(path, shape, file_type, put, attributes);
}

void FileWriter::write_attribute(hid_t object, const std::string& path, const std::string& name, const Dims& shape,
                                 hid_t file_type, hid_t memory_type, const void* data) {
  const Handle space = shape.empty() ? Handle() : make_space(shape);
  const Handle attribute(H5Acreate2(object, name.c_str(), file_type, shape.empty() ? scalar_.get() : space.get(),
                                    H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  check(attribute.is_valid(), "attribute " + path + "@" + name + " cannot be written");
  if (!has_elements(shape)) return;
  check(H5Awrite(attribute.get(), memory_type, data) >= 0, "attribute " + path + "@" + name + " cannot be written");
}

void FileWriter::write_attribute(const std::string& object, const std::string& name, const Dims& shape, hid_t file_type,
                                 hid_t memory_type, const void* data) {
  const Handle opened(H5Oopen(file_.get(), object.c_str(), H5P_DEFAULT), H5Oclose);
  check(opened.is_valid(), "attribute " + object + "@" + name + " cannot be written");
  write_attribute(opened.get(), object, name, shape, file_type, memory_type, data);
}

void FileWriter::write_attributes(hid_t dataset, const std::string& path, const ArrayAttributes& given) {
  ArrayAttributes attributes = given;
  if (attributes.description.empty()) {
    const auto match = layout_ == nullptr ? std::nullopt : find_row(*layout_, path);
    BOUGH_DEMAND(match.has_value());
    attributes.description = match->fill_in(match->row->description, texts_);
    if (attributes.dims.empty()) attributes.dims = match->fill_in(match->row->dims, texts_);
  }
  for (const auto& [name, text] : {std::pair("description", &attributes.description), {"dims", &attributes.dims}}) {
    const char* data = text->c_str();
    write_attribute(dataset, path, name, Dims{}, string_type_.get(), string_type_.get(), &data);
  }
}

void FileWriter::write_attribute(const std::string& object, const std::string& name, const std::string& text) {
  const char* data = text.c_str();
  write_attribute(object, name, Dims{}, string_type_.get(), string_type_.get(), &data);
}

void FileWriter::write_attribute(const std::string& object, const std::string& name, int value) {
  write_attribute(object, name, Dims{}, H5T_STD_I32LE, H5T_NATIVE_INT, &value);
}

void FileWriter::write_attribute(const std::string& object, const std::string& name, const std::vector<int>& values) {
  write_attribute(object, name, Dims{values.size()}, H5T_STD_I32LE, H5T_NATIVE_INT, values.data());
}

void FileWriter::write_attribute(const std::string& object, const std::string& name,
                                 const std::vector<std::string>& words) {
  std::vector<const char*> data;
  for (const auto& w : words) data.push_back(w.c_str());
  write_attribute(object, name, Dims{words.size()}, string_type_.get(), string_type_.get(), data.data());
}

void FileWriter::write_source(const std::vector<std::pair<std::string, std::string>>& source) {
  std::vector<const char*> data;
  for (const auto& [name, hash] : source) {
    data.push_back(name.c_str());
    data.push_back(hash.c_str());
  }
  write_attribute("/", "source", Dims{source.size(), 2}, string_type_.get(), string_type_.get(), data.data());
}

void FileWriter::write_numbers(const std::string& path, const Dims& shape, const double* data,
                               const ArrayAttributes& attributes) {
  write(path, shape, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, data, attributes);
}

void FileWriter::write_floats(const std::string& path, const Dims& shape, const float* data,
                              const ArrayAttributes& attributes) {
  write(path, shape, H5T_IEEE_F32LE, H5T_NATIVE_FLOAT, data, attributes);
}

void FileWriter::write_items(const std::string& path, const Dims& shape,
                             const std::function<void(std::size_t, double*)>& fill, const ArrayAttributes& attributes) {
  constexpr std::size_t kAtOnce = 500'000;  // numbers
  const std::size_t num = shape.at(0);
  std::size_t size = 1;
  for (std::size_t i = 1; i < shape.size(); ++i) size *= shape[i];
  const std::size_t slab = std::max<std::size_t>(1, kAtOnce / std::max<std::size_t>(1, size));
  std::vector<double> data(std::min(slab, num) * size);
  const auto put = [&](hid_t dataset, hid_t space) {
    Dims start(shape.size(), 0), count = shape;
    bool is_written = true;
    for (std::size_t first = 0; is_written && first < num; first += slab) {
      start[0] = first;
      count[0] = std::min(slab, num - first);
      for (std::size_t i = 0; i < count[0]; ++i) fill(first + i, data.data() + i * size);
      const Handle memory = make_space(count);
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
      is_written = H5Dwrite(dataset, H5T_NATIVE_DOUBLE, memory.get(), space, H5P_DEFAULT, data.data()) >= 0;
    }
    return is_written;
  };
  write(path, shape, H5T_IEEE_F64LE, put, attributes);
}

void FileWriter::write_integers(const std::string& path, const Dims& shape, const int* data,
                                const ArrayAttributes& attributes) {
  write(path, shape, H5T_STD_I32LE, H5T_NATIVE_INT, data, attributes);
}

void FileWriter::write_strings(const std::string& path, const std::vector<std::string>& words,
                               const ArrayAttributes& attributes) {
  std::vector<const char*> data;
  for (const auto& w : words) data.push_back(w.c_str());
  write(path, {words.size()}, string_type_.get(), string_type_.get(), data.data(), attributes,
        make_string_transfer(words.size()).get());
}

void FileWriter::write_number(const std::string& path, double value, const ArrayAttributes& attributes) {
  write_numbers(path, {1}, &value, attributes);
}

void FileWriter::write_vector(const std::string& path, const Eigen::VectorXd& v, const ArrayAttributes& attributes) {
  write_numbers(path, {static_cast<hsize_t>(v.size())}, v.data(), attributes);
}

void FileWriter::write_vector_with_zeros(const std::string& path, const Eigen::VectorXd& v,
                                         const ArrayAttributes& attributes) {
  constexpr Eigen::Index kChunk = 4096;
  if (v.size() < 2 * kChunk) return write_vector(path, v, attributes);
  errno = 0;
  make_parents(path);
  const Handle space = make_space({static_cast<hsize_t>(v.size())});
  Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.get(), false);
  const hsize_t chunk = kChunk;
  H5Pset_chunk(creation.get(), 1, &chunk);
  {
    Handle dataset(
        H5Dcreate2(file_.get(), path.c_str(), H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
        H5Dclose);
    check(dataset.is_valid(), "dataset " + path + " cannot be written");
    for (Eigen::Index from = 0; from < v.size(); from += kChunk) {
      const Eigen::Index size = std::min(kChunk, v.size() - from);
      if (v.segment(from, size).isZero(0)) continue;
      const auto start = static_cast<hsize_t>(from), count = static_cast<hsize_t>(size);
      const Handle memory = make_space({count});
      H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, &start, nullptr, &count, nullptr);
      check(H5Dwrite(dataset.get(), H5T_NATIVE_DOUBLE, memory.get(), space.get(), H5P_DEFAULT, v.data() + from) >= 0,
            "dataset " + path + " cannot be written");
    }
    write_attributes(dataset.get(), path, attributes);
    check(dataset.reset(), "dataset " + path + " cannot be written");
  }
}

void FileWriter::write_matrix(const std::string& path, const Eigen::MatrixXd& m, const ArrayAttributes& attributes) {
  const RowMajor rows = m;
  write_numbers(path, {static_cast<hsize_t>(m.rows()), static_cast<hsize_t>(m.cols())}, rows.data(), attributes);
}

void FileWriter::write_integers(const std::string& path, const std::vector<int>& data,
                                const ArrayAttributes& attributes) {
  write_integers(path, {data.size()}, data.data(), attributes);
}

void FileWriter::write_integers(const std::string& path, const Eigen::MatrixXi& m, const ArrayAttributes& attributes) {
  const Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> rows = m;
  write_integers(path, {static_cast<hsize_t>(m.rows()), static_cast<hsize_t>(m.cols())}, rows.data(), attributes);
}

void FileWriter::attach_scale(const std::string& scale, const std::vector<std::string>& users) {
  check(hdf5::attach_scale(file_.get(), scale, users), "the scale " + scale + " cannot be written");
}

void FileWriter::commit() {
  errno = 0;
  groups_.clear();
  check(flush_file(file_.get()), "the file cannot be written");
  check(file_.reset(), "the file cannot be written");
  const bool is_there = part_->commit();
  errno = part_->error().value();
  check(is_there, "the file cannot be put in its place");
  trust_file(path_);
}

std::string FileWriter::get_image() {
  groups_.clear();
  check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL) >= 0, "the file cannot be written");
  const auto size = H5Fget_file_image(file_.get(), nullptr, 0);
  check(size > 0, "the file cannot be written");
  std::string image(static_cast<std::size_t>(size), '\0');
  check(H5Fget_file_image(file_.get(), image.data(), image.size()) == size, "the file cannot be written");
  file_.reset();
  return image;
}

void FileWriter::link(const std::string& path, const std::string& existing) {
  make_group(path.substr(0, path.rfind('/')));
  check(H5Lcreate_hard(file_.get(), existing.c_str(), file_.get(), path.c_str(), H5P_DEFAULT, H5P_DEFAULT) >= 0,
        "link " + path + " cannot be written");
}

void write_mesh(FileWriter& file, const records::BodyMesh& mesh) {
  if (mesh.grid_id.empty()) return;
  file.write_integers("/grids/id", mesh.grid_id);
  file.write_matrix("/grids/xyz", mesh.grid_xyz);
  file.link("/mesh/grid_id", "/grids/id");
  file.link("/mesh/grid_xyz", "/grids/xyz");
  std::vector<std::string> names;
  for (const auto& block : mesh.blocks) {
    std::string name = block.type;
    for (int k = 2; std::find(names.begin(), names.end(), name) != names.end(); ++k) {
      name = block.type + "-" + std::to_string(k);
    }
    const std::string path = "/mesh/elements/" + name;
    file.write_integers(path + "/connectivity", block.connectivity);
    file.write_integers(path + "/id", block.element_id);
    file.write_attribute(path, "type", block.type);
    file.write_attribute(path, "order", static_cast<int>(names.size()));
    names.push_back(name);
  }
}

void write_mode_shapes(FileWriter& file, const std::vector<Eigen::MatrixXd>& phi, int num_modes) {
  const auto fill = [&](std::size_t k, double* data) {
    const auto& node = phi[k];
    BOUGH_DEMAND(node.rows() == 6 && node.cols() == num_modes);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < num_modes; ++j) *data++ = node(i, j);
  };
  file.write_items("/modes/phi", {phi.size(), 6, static_cast<hsize_t>(num_modes)}, fill);
}

void write_mode_kinds(FileWriter& file, const std::vector<records::ModeKind>& kinds) {
  std::vector<std::string> words;
  for (const auto kind : kinds) words.emplace_back(records::get_name(kind));
  file.write_strings("/modes/kind", words);
}

}  // namespace bough::hdf5
