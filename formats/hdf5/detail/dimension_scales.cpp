#include "formats/hdf5/detail/dimension_scales.hpp"

#include <algorithm>

namespace bough::hdf5 {

namespace {

/// Writes text as H5DS does: fixed length, with its terminating zero.
bool write_fixed_text(hid_t object, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type.get(), text.size() + 1);
  const Handle attribute(H5Acreate2(object, name, type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute.is_valid() && H5Awrite(attribute.get(), type.get(), text.c_str()) >= 0;
}

/// Writes DIMENSION_LIST: the scales of each dimension.
bool write_dimension_list(hid_t dataset, hobj_ref_t& scale) {
  const Handle dataspace(H5Dget_space(dataset), H5Sclose);
  const auto rank = static_cast<hsize_t>(std::max(0, H5Sget_simple_extent_ndims(dataspace.get())));
  if (rank == 0) return true;
  const Handle type(H5Tvlen_create(H5T_STD_REF_OBJ), H5Tclose), space(H5Screate_simple(1, &rank, nullptr), H5Sclose);
  std::vector<hvl_t> lists(rank, hvl_t{0, nullptr});
  lists[0] = {1, &scale};
  const Handle attribute(H5Acreate2(dataset, "DIMENSION_LIST", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute.is_valid() && H5Awrite(attribute.get(), type.get(), lists.data()) >= 0;
}

struct User {
  hobj_ref_t dataset;
  int dimension;
};

bool write_reference_list(hid_t scale, const std::vector<User>& users) {
  const Handle type(H5Tcreate(H5T_COMPOUND, sizeof(User)), H5Tclose);
  H5Tinsert(type.get(), "dataset", HOFFSET(User, dataset), H5T_STD_REF_OBJ);
  H5Tinsert(type.get(), "dimension", HOFFSET(User, dimension), H5T_NATIVE_INT);
  const hsize_t count = users.size();
  const Handle space(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle attribute(H5Acreate2(scale, "REFERENCE_LIST", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  return attribute.is_valid() && H5Awrite(attribute.get(), type.get(), users.data()) >= 0;
}

}  // namespace

bool attach_scale(hid_t file, const std::string& scale, const std::vector<std::string>& users) {
  hobj_ref_t reference;
  const Handle own(H5Dopen2(file, scale.c_str(), H5P_DEFAULT), H5Dclose);
  if (!own.is_valid() || H5Rcreate(&reference, file, scale.c_str(), H5R_OBJECT, -1) < 0) return false;
  if (!write_fixed_text(own.get(), "CLASS", "DIMENSION_SCALE") ||
      !write_fixed_text(own.get(), "NAME", scale.substr(scale.rfind('/') + 1)))
    return false;
  std::vector<User> list;
  for (const auto& path : users) {
    const Handle dataset(H5Dopen2(file, path.c_str(), H5P_DEFAULT), H5Dclose);
    User user{};  // its padding is written too
    if (!dataset.is_valid() || !write_dimension_list(dataset.get(), reference) ||
        H5Rcreate(&user.dataset, file, path.c_str(), H5R_OBJECT, -1) < 0)
      return false;
    list.push_back(user);
  }
  return list.empty() || list.size() > kMaxUsers || write_reference_list(own.get(), list);
}

}  // namespace bough::hdf5
