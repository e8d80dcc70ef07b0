#include "formats/hdf5/detail/results_header.hpp"

#include <algorithm>
#include <cerrno>
#include <vector>

#include "base/version.hpp"
#include "formats/hdf5/detail/results_layout.hpp"
#include "formats/hdf5/files.hpp"

namespace bough::hdf5 {

namespace {

void write_source(GrowingFile& file, const std::vector<std::pair<std::string, std::string>>& source) {
  const Handle type = make_string_type();
  const hsize_t shape[2] = {source.size(), 2};
  const Handle space(H5Screate_simple(2, shape, nullptr), H5Sclose);
  const Handle attribute(H5Acreate2(file.get(), "source", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  std::vector<const char*> data;
  for (const auto& [name, hash] : source) {
    data.push_back(name.c_str());
    data.push_back(hash.c_str());
  }
  file.check(attribute.is_valid() && (data.empty() || H5Awrite(attribute.get(), type.get(), data.data()) >= 0),
             "attribute source cannot be written");
}

}  // namespace

void write_provenance(GrowingFile& file, const records::ResultsHeader& header) {
  file.check(write_text_attribute(file.get(), "format", kResultsFormat) &&
                 write_text_attribute(file.get(), "format_version", kResultsFormatVersion) &&
                 write_text_attribute(file.get(), "bough_version", get_version()),
             "the file cannot be written");
  write_source(file, header.source);
}

void write_settings(GrowingFile& file, const records::ResultsHeader& header) {
  if (exists(file.get(), "/system")) {
    const Handle old(H5Dopen2(file.get(), "/system", H5P_DEFAULT), H5Dclose);
    const Handle old_space(H5Dget_space(old.get()), H5Sclose);
    if (H5Sget_simple_extent_npoints(old_space.get()) != 1) H5Ldelete(file.get(), "/system", H5P_DEFAULT);
  }
  if (!exists(file.get(), "/system")) {
    const Handle type = make_string_type();
    const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
    const Handle system(
        H5Dcreate2(file.get(), "/system", type.get(), space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    const char* text = header.system_text.c_str();
    file.check(system.is_valid() && H5Dwrite(system.get(), type.get(), H5S_ALL, H5S_ALL, H5P_DEFAULT, &text) >= 0 &&
                   write_text_attribute(system.get(), "description", "the system file of the run, TOML") &&
                   write_text_attribute(system.get(), "dims", "1"),
               "/system cannot be written");
  }
  const Handle settings(exists(file.get(), "/settings")
                            ? H5Gopen2(file.get(), "/settings", H5P_DEFAULT)
                            : H5Gcreate2(file.get(), "/settings", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                        H5Gclose);
  for (const auto& [name, value] : header.settings) {
    file.check(write_text_attribute(settings.get(), name, value), "setting " + name + " cannot be written");
  }
}

void write_resumed(GrowingFile& file, const records::ResultsHeader& header, double time) {
  const Handle text = make_string_type();
  if (!exists(file.get(), "/resumed")) {
    file.make_column("/resumed/time", 1, H5T_IEEE_F64LE, "times at which the run was resumed", "T");
    file.make_column("/resumed/system", 1, text.get(), "the system file it was resumed with, TOML", "1");
  }
  Handle times = file.open_column("/resumed/time"), texts = file.open_column("/resumed/system");
  const Handle space(H5Dget_space(times.get()), H5Sclose);
  const auto row = static_cast<hsize_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space.get())));
  const char* system = header.system_text.c_str();
  file.append(times, row, 1, 1, H5T_NATIVE_DOUBLE, &time);
  file.append(texts, row, 1, 1, text.get(), &system);
}

void write_energy_error(GrowingFile& file, double worst) {
  const Handle group(exists(file.get(), "/energy")
                         ? H5Gopen2(file.get(), "/energy", H5P_DEFAULT)
                         : H5Gcreate2(file.get(), "/energy", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                     H5Gclose);
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Aexists(group.get(), kEnergyError) > 0
          ? H5Aopen(group.get(), kEnergyError, H5P_DEFAULT)
          : H5Acreate2(group.get(), kEnergyError, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose);
  file.check(attribute.is_valid() && H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &worst) >= 0,
             "the energy error cannot be written");
}

void add_wall_time(GrowingFile& file, double seconds) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const bool is_there = H5Aexists(file.get(), kWallTime) > 0;
  const Handle attribute(is_there
                             ? H5Aopen(file.get(), kWallTime, H5P_DEFAULT)
                             : H5Acreate2(file.get(), kWallTime, H5T_IEEE_F64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT),
                         H5Aclose);
  double before = 0;
  if (is_there) {
    const Handle found(H5Aget_space(attribute.get()), H5Sclose);
    if (H5Sget_simple_extent_npoints(found.get()) == 1) H5Aread(attribute.get(), H5T_NATIVE_DOUBLE, &before);
  }
  const double sum = before + seconds;
  file.check(attribute.is_valid() && H5Awrite(attribute.get(), H5T_NATIVE_DOUBLE, &sum) >= 0,
             "the wall time cannot be written");
}

void write_state(GrowingFile& file, bool completed, const std::string& reason) {
  errno = 0;
  file.write_integer(file.get(), "completed", completed ? 1 : 0, H5T_STD_I32LE);
  file.check(write_text_attribute(file.get(), "reason", reason), "attribute reason cannot be written");
}

}  // namespace bough::hdf5
