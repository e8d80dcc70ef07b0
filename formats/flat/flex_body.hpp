#pragma once
/// \file Flat flexible-body file (docs/formats/flat.md): named little-endian arrays, read without HDF5.
#include <string>
#include <string_view>
#include <vector>

#include "formats/records/flex_body.hpp"

namespace bough::flat {

/// Returns true if the file exists and begins with "bough-flat ", in any version.
bool is_flex_body(const std::string& path);

/// Writes every field of the body; numbers keep all bits. The file appears whole or not at all (base/part_file.hpp).
///
/// \pre the arrays of the body have the shapes that formats/records/flex_body.hpp gives them.
/// \throws ComputationError "flat.write".
void write_flex_body(const std::string& path, const records::FlexBody& body);

/// Reads what write_flex_body wrote.
///
/// \throws InputError "flat.cannot-read", "flat.not-flat", "flat.version", "flat.damaged", "flat.missing",
/// "flat.shape" or "flat.value".
records::FlexBody read_flex_body(const std::string& path);

/// Returns the bytes of the file. Equal bodies give equal bytes.
std::string format_flex_body(const records::FlexBody& body);

/// Reads the bytes of a file.
///
/// \param label  names the bytes in messages.
/// \throws as read_flex_body, except "flat.cannot-read".
records::FlexBody parse_flex_body(std::string_view bytes, const std::string& label);

struct ArrayInfo {
  std::string name;         ///< "/modal/mass"
  std::string type;         ///< "float64", "float32", "int32" or "text"
  std::vector<long> shape;  ///< empty: one value
  std::string text;         ///< the bytes of a text, cut after 200
};

/// Returns the arrays of a file in their order. \throws as read_flex_body, except "flat.missing", "flat.shape" and
/// "flat.value".
std::vector<ArrayInfo> list_arrays(const std::string& path);

}  // namespace bough::flat
