#pragma once
/// \file Frequency and transient responses of decks in HDF5 (docs/formats/response.md).
#include <string>

#include "formats/records/deck_response.hpp"

namespace bough::hdf5 {

inline constexpr const char* kResponseFormatVersion = "1.0";

/// Format "bough-frequency" or "bough-transient". Throws ComputationError "hdf5.write".
void write_response(const records::DeckResponse& response, const std::string& path);
/// The bytes of that file, without a file.
std::string make_response_image(const records::DeckResponse& response);
/// Throws InputError as the other readers (hdf5/files.hpp).
records::DeckResponse read_response(const std::string& path);

}  // namespace bough::hdf5
