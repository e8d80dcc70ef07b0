#pragma once
/// \file The whole state of a simulation as bytes: named sections of numbers, with a checksum.
#include <cstdint>
#include <span>
#include <vector>

#include "formats/records/results.hpp"

namespace bough::embed {

/// 64-bit FNV-1a, from a hash so far on.
std::uint64_t calc_hash(std::span<const std::byte> bytes, std::uint64_t hash = 14695981039346656037u);

/// `fingerprint`: hash of the system and options, which must be equal when the state is restored.
std::vector<std::byte> encode_state(const records::Checkpoint& state, std::uint64_t fingerprint);
/// \param size  fewest bytes that a saved state takes. Bytes after the state are skipped.
/// Throws InputError "embed.bad-state".
records::Checkpoint decode_state(std::span<const std::byte> bytes, std::uint64_t fingerprint, std::size_t size);

}  // namespace bough::embed
