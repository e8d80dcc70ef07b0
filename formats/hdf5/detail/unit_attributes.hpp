#pragma once
/// \file Unit labels as root attributes length_unit, mass_unit, time_unit and force_unit.
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"
#include "formats/records/unit_labels.hpp"

namespace bough::hdf5 {

/// Writes the labels that are given.
inline void write_unit_labels(FileWriter& file, const records::UnitLabels& units) {
  for (const auto& [name, label] : {std::pair("length_unit", &units.length), std::pair("mass_unit", &units.mass),
                                    std::pair("time_unit", &units.time), std::pair("force_unit", &units.force)})
    if (!label->empty()) file.write_attribute("/", name, *label);
}

/// Reads the labels; empty in files without them.
inline records::UnitLabels read_unit_labels(FileReader& file) {
  return {file.read_attribute("/", "length_unit"), file.read_attribute("/", "mass_unit"),
          file.read_attribute("/", "time_unit"), file.read_attribute("/", "force_unit")};
}

}  // namespace bough::hdf5
