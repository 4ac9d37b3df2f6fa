// Signatures as text, as archives and the metadata of `.reeb` files keep them (spec/signature.md).
#pragma once

#include <string>
#include <vector>

#include "retrieval/signature.h"

namespace reeb::tools {

/// A frame that was signed.
struct SignedFrame {
  uint32_t frame = 1;  ///< from 1
  retrieval::Signature signature;
};

/// Key of the metadata entry.
inline constexpr const char* kSignatureKey = "shape signature";

/// Two digits a byte.
std::string signature_text(const retrieval::Signature& signature);
/// False where it is none, or one of a mesh without a surface.
bool parse_signature(const std::string& text, retrieval::Signature& out);

/// Value of the metadata entry, and back; false where it is none.
std::string stored_signatures(const std::vector<SignedFrame>& frames);
bool parse_stored(const std::string& text, std::vector<SignedFrame>& out);

}  // namespace reeb::tools
