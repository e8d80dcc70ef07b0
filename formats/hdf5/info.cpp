#include <algorithm>
#include <set>

#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/layouts.hpp"

namespace bough::hdf5 {

namespace {

Dims get_shape(hid_t space) {
  Dims dims(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (!dims.empty()) H5Sget_simple_extent_dims(space, dims.data(), nullptr);
  return dims;
}

std::string describe_type(hid_t type) {
  const std::string bits = std::to_string(8 * H5Tget_size(type));
  switch (H5Tget_class(type)) {
    case H5T_FLOAT:
      return "float" + bits;
    case H5T_INTEGER:
      return (H5Tget_sign(type) == H5T_SGN_NONE ? "uint" : "int") + bits;
    case H5T_STRING:
      return "string";
    case H5T_COMPOUND:
      return "compound";
    case H5T_ENUM:
      return "enum";
    default:
      return "other";
  }
}

/// Any attribute as text, entries joined by ", ".
std::string read_any_attribute(hid_t object, const char* name) {
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  const Handle type(H5Aget_type(attribute.get()), H5Tclose);
  const Handle space(H5Aget_space(attribute.get()), H5Sclose);
  const auto count = static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  if (count == 0) return {};
  std::string text;
  auto add = [&](const std::string& word) { text += (text.empty() ? "" : ", ") + word; };
  const H5T_class_t kind = H5Tget_class(type.get());
  if (kind == H5T_STRING && H5Tis_variable_str(type.get()) > 0) {
    const Handle memory = make_string_type();
    std::vector<char*> data(count, nullptr);
    if (H5Aread(attribute.get(), memory.get(), data.data()) < 0) return {};
    for (char* word : data) {
      add(word ? word : "");
      H5free_memory(word);
    }
  } else if (kind == H5T_STRING) {
    return read_text_attribute(object, name);
  } else if (kind == H5T_INTEGER) {
    std::vector<long long> data(count);
    if (H5Aread(attribute.get(), H5T_NATIVE_LLONG, data.data()) < 0) return {};
    for (const auto x : data) add(std::to_string(x));
  } else if (kind == H5T_FLOAT) {
    std::vector<double> data(count);
    if (H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, data.data()) < 0) return {};
    for (const double x : data) {
      char buffer[32];
      std::snprintf(buffer, sizeof buffer, "%.10g", x);
      add(buffer);
    }
  }
  return text;
}

herr_t add_attribute_name(hid_t, const char* name, const H5A_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

std::vector<std::string> get_attribute_names(hid_t object) {
  std::vector<std::string> names;
  H5Aiterate2(object, H5_INDEX_NAME, H5_ITER_INC, nullptr, add_attribute_name, &names);
  return names;
}

herr_t add_child_name(hid_t, const char* name, const H5L_info_t*, void* names) {
  static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  return 0;
}

void add_object(hid_t parent, const std::string& path, std::set<haddr_t>& groups, FileInfo& info) {
  const Handle object(H5Oopen(parent, path.c_str(), H5P_DEFAULT), H5Oclose);
  if (!object.is_valid()) {
    info.objects.push_back({path, "", "unreadable", "", ""});
    return;
  }
  if (H5Iget_type(object.get()) == H5I_DATASET) {
    const Handle space(H5Dget_space(object.get()), H5Sclose);
    const Handle type(H5Dget_type(object.get()), H5Tclose);
    info.objects.push_back({path, describe_shape(get_shape(space.get())), describe_type(type.get()),
                            read_text_attribute(object.get(), "description"),
                            read_text_attribute(object.get(), "dims")});
    return;
  }
  if (H5Iget_type(object.get()) != H5I_GROUP) return;
  if (!groups.insert(get_address(object.get())).second) {
    info.objects.push_back({path, "", "group", "another name of a group listed above", ""});
    return;
  }
  if (path != "/") {
    for (const auto& name : get_attribute_names(object.get())) {
      info.objects.push_back({path + "@" + name, "", "attribute", read_any_attribute(object.get(), name.c_str()), ""});
    }
  }
  std::vector<std::string> names;
  H5Literate(object.get(), H5_INDEX_NAME, H5_ITER_INC, nullptr, add_child_name, &names);
  for (const auto& name : names) add_object(parent, (path == "/" ? "" : path) + "/" + name, groups, info);
}

}  // namespace

FileInfo read_info(const std::string& path) {
  QuietErrors quiet;
  const Handle file = open_file(path);
  FileInfo info;
  const Handle root(H5Gopen2(file.get(), "/", H5P_DEFAULT), H5Gclose);
  for (const auto& name : get_attribute_names(root.get())) {
    info.attributes[name] = read_any_attribute(root.get(), name.c_str());
  }
  std::set<haddr_t> groups;
  add_object(file.get(), "/", groups, info);
  // Files of other programs may lack descriptions.
  const auto format = info.attributes.find("format");
  const Layout* layout = format == info.attributes.end() ? nullptr : find_layout(format->second);
  if (layout != nullptr)
    for (auto& object : info.objects) {
      if (object.shape.empty() || !object.description.empty()) continue;
      if (const auto match = find_row(*layout, object.path)) {
        object.description = match->fill_in(match->row->description);
        if (object.dims.empty()) object.dims = match->fill_in(match->row->dims);
      }
    }
  return info;
}

}  // namespace bough::hdf5
