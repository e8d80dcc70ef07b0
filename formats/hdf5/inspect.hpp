#pragma once
/// \file A look through a whole HDF5 file in a process of its own, before this one reads anything of it.
#include <string>
#include <vector>

#include "base/diagnostic.hpp"

namespace bough::hdf5 {

/// What is wrong with the file: "hdf5.outside" (links, storage or virtual datasets that reach other files),
/// "hdf5.damaged" (claims of size that the bytes stored cannot hold; groups nested without end). Every link, attribute
/// and number is read as Bough reads them. This may crash: the library does not survive some damaged files.
std::vector<Diagnostic> find_faults(const std::string& path);

/// The same in a forked process, whose crash, hunger or endless loop is a fault of the file; a file seen before and not
/// changed since is not looked at again. Throws InputError.
void inspect_file(const std::string& path);

/// A file that this process has written whole is as good as looked at, until it changes.
void trust_file(const std::string& path);

/// What find_faults finds, as text from one process to another; empty: nothing. Throws what find_faults throws.
std::string write_faults(const std::string& path);

}  // namespace bough::hdf5
