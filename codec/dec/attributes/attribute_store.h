// Decodes attributes when they are first asked for and keeps them, within the memory that the
// caller allows.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <utility>

#include "bitstream/container.h"
#include "bitstream/memory_account.h"
#include "codec/common/base/attributes.h"
#include "codec/dec/attributes/animated_decoder.h"
#include "codec/dec/attributes/site_numbers.h"
#include "codec/dec/group_store.h"

namespace reeb {

struct KeptAttribute {
  Attribute attribute;  ///< of an animated one, without values
  AttributeHeader header;
  AttributeSurface surface;        ///< of an animated one
  SiteMesh sites;                  ///< of computed normals
  std::vector<float> corrections;  ///< that turn them in all frames, [site][u, v]
  Lease lease;

  uint64_t bytes() const;  ///< that it takes
};

/// An animated attribute in a group.
struct KeptAttributeGroup {
  uint64_t offset = UINT64_MAX;  ///< of the chunk
  std::shared_ptr<const KeptAttribute> attribute;
  AttributeFrames frames;
  Lease lease;
};

/// One thread at a time.
class AttributeStore {
 public:
  /// All must outlive the store.
  AttributeStore(ByteSource& source, MemoryAccount& account, GroupStore& groups)
      : source_(source), account_(account), groups_(groups) {}

  /// From now on, calls throw Stopped where it is requested.
  void set_stop(const StopToken& stop) { stop_ = stop; }

  /// Values of a static attribute, sites of an animated one; `reference`: of its shot.
  Status get(const AttributeChunk& chunk, const ReferenceChunk& reference,
             std::shared_ptr<const KeptAttribute>& out);
  /// The numbers of a static attribute.
  static void get_static(const std::shared_ptr<const KeptAttribute>& kept, SiteNumbers& out);
  /// The numbers of an animated attribute in frame t of a group; of computed normals, the
  /// corrections.
  Status get_frame(const std::shared_ptr<const KeptAttribute>& kept,
                   const AttributeGroupChunk& chunk, uint32_t t, unsigned threads,
                   const StopToken& stop, SiteNumbers& out);
  /// Computed normals for positions of the vertices; `corrections`: of the frame, where they differ
  /// from frame to frame.
  Status get_normals(const std::shared_ptr<const KeptAttribute>& kept, std::span<const float> xyz,
                     const SiteNumbers& corrections, SiteNumbers& out);
  /// What an attribute is, without values.
  Status describe(const AttributeChunk& chunk, Attribute& out);
  Status get_resource(const ResourceChunk& chunk, Resource& out);
  /// As many of its bytes as `buffer` holds; `length`: how many there are.
  Status copy_resource(const ResourceChunk& chunk, std::span<uint8_t> buffer, size_t& length);

 private:
  template <class AnyChunk>
  Status load(const AnyChunk& wanted, std::vector<uint8_t>& buffer, AnyChunk& chunk, Lease& lease);
  Status grow(uint64_t bytes, Lease& lease);
  Status open_sites(const AttributeChunk& chunk, const ShotSurface& surface, KeptAttribute& kept);
  Status decode_group(const std::shared_ptr<const KeptAttribute>& kept,
                      const AttributeGroupChunk& wanted, unsigned threads, const StopToken& stop,
                      KeptAttributeGroup& out);

  ByteSource& source_;
  MemoryAccount& account_;
  GroupStore& groups_;
  StopToken stop_;
  std::map<std::pair<uint32_t, uint32_t>, std::shared_ptr<KeptAttribute>> kept_;
  /// By index, the one used last.
  std::map<uint32_t, std::shared_ptr<const KeptAttributeGroup>> groups_kept_;
};

}  // namespace reeb
