#pragma once
/// \file Version of Bough and the versions of the file formats it writes.
namespace bough {

/// Version of this build, "major.minor.patch".
const char* get_version();

inline constexpr const char* kFlexBodyFormatVersion = "1.1";
inline constexpr const char* kThirdOrderFormatVersion = "1.3";  ///< of a flexible body that has /third_order
inline constexpr const char* kResultsFormatVersion = "1.1";
inline constexpr const char* kModesFormatVersion = "1.0";
inline constexpr const char* kMatricesFormatVersion = "1.0";
inline constexpr const char* kStaticFormatVersion = "1.0";

}  // namespace bough
