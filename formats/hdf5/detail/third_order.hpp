#pragma once
/// \file /third_order of a flexible-body file (docs/formats/flexbody.md).
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

}  // namespace bough::hdf5
