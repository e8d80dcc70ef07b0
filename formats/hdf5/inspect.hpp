#pragma once
/// \\file Inspection of a whole HDF5 file in a separate process, before this one reads it.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::hdf5 {

/// Faults of the file: "hdf5.outside" (links, storage or virtual datasets that reach other files), "hdf5.damaged"
/// (sizes larger than the stored bytes; groups nested without end). Every link, attribute and number is read as Bough
/// reads them. May crash: the library does not survive some damaged files.
std::vector<Diagnostic> find_faults(const std::string& path);

/// Runs find_faults in a forked process, whose crash, excess of memory or endless loop is a fault of the file. A file
/// inspected before and not changed since is skipped. Throws InputError.
void inspect_file(const std::string& path);

/// A file that this process has written whole is as good as looked at, until it changes.
void trust_file(const std::string& path);

/// Text of the faults, for transfer between processes; empty: none. Throws the exceptions of find_faults.
std::string write_faults(const std::string& path);

}  // namespace bough::hdf5
