#pragma once
/// \file /third_order and /next_order of a flexible-body file (docs/formats/flexbody.md).
#include "formats/hdf5/detail/reader.hpp"
#include "formats/hdf5/detail/writer.hpp"

namespace bough::hdf5 {

/// Mass integrals as the group `path`; nothing if there are none.
void write_integrals(FileWriter& file, const std::string& path, const records::MassIntegrals& integrals);
records::MassIntegrals read_integrals(FileReader& file, const std::string& path, long n);

/// Nothing for a body without third order.
void write_third_order(FileWriter& file, const records::FlexBody& body);
/// After the modes, nodes and locators.
void read_third_order(FileReader& file, records::FlexBody& body);

/// Nothing for a body without the energy of its soft modes.
void write_next_order(FileWriter& file, const records::NextOrder& next);
/// \param num_modes  of the body.
records::NextOrder read_next_order(FileReader& file, int num_modes);

}  // namespace bough::hdf5
