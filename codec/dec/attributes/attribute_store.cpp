#include "codec/dec/attributes/attribute_store.h"

#include <algorithm>
#include <cstring>

#include "codec/dec/attributes/attribute_decoder.h"
#include "codec/dec/attributes/computed_normals.h"
#include "codec/dec/group_memory.h"

namespace reeb {

Status AttributeStore::grow(uint64_t bytes, Lease& lease) {
  if (lease.grow(account_, bytes)) return {};
  kept_.clear();
  groups_kept_.clear();
  return lease.grow(account_, bytes)
             ? Status()
             : Status::limit("the attributes need more memory than the limit allows");
}

template <class AnyChunk>
Status AttributeStore::load(const AnyChunk& wanted, std::vector<uint8_t>& buffer, AnyChunk& chunk,
                            Lease& lease) {
  if (Status s = grow(wanted.size, lease); !s.ok()) return s;
  chunk = wanted;
  const auto lock = groups_.lock_source();
  return load_chunk(source_, buffer, chunk);
}

Status AttributeStore::describe(const AttributeChunk& wanted, Attribute& out) {
  AttributeChunk chunk;
  std::vector<uint8_t> buffer;
  Lease lease;
  if (Status s = load(wanted, buffer, chunk, lease); !s.ok()) return s;
  return describe_attribute(chunk, out);
}

uint64_t KeptAttribute::bytes() const {
  const uint64_t sites_bytes =
      (sites.triangles.size() + sites.grid.size() + sites.vertex.size()) * sizeof(uint32_t);
  return attribute.values.size() + surface.of_element.size() * sizeof(uint32_t) + sites_bytes +
         corrections.size() * sizeof(float) +
         (header.in_groups() ? kept_memory(surface.surface) : 0);
}

// What an animated attribute's groups, or its normals, are decoded on.
Status AttributeStore::open_sites(const AttributeChunk& chunk, const ShotSurface& surface,
                                  KeptAttribute& kept) {
  if (Status s = describe_attribute(chunk, kept.attribute); !s.ok()) return s;
  Sites sites;
  if (Status s = decode_attribute_sites(chunk, surface, stop_, sites, kept.corrections); !s.ok())
    return s;
  if (chunk.header.computed()) kept.sites = sites.mesh;
  if (!chunk.header.in_groups()) {
    kept.surface.of_element = std::move(sites.of_element);
    return {};
  }
  if (Status s = grow(attribute_surface_memory(sites.mesh.count), kept.lease); !s.ok()) return s;
  kept.surface = attribute_surface(std::move(sites), stop_);
  return {};
}

void AttributeStore::get_static(const std::shared_ptr<const KeptAttribute>& kept,
                                SiteNumbers& out) {
  out.attribute = kept;
  out.numbers = kept->attribute.values;
  out.site_of = {};
  out.bytes = kept->attribute.element_bytes();
}

Status AttributeStore::get_normals(const std::shared_ptr<const KeptAttribute>& kept,
                                   std::span<const float> xyz, const SiteNumbers& corrections,
                                   SiteNumbers& out) {
  out = {};
  const uint64_t own = uint64_t{kept->sites.count} * 8 * sizeof(float);
  if (Status s = grow(turned_normals_memory(kept->sites) + own, out.lease); !s.ok()) return s;
  std::vector<float> normals, turning(corrections.own.size() / sizeof(float));
  if (!turning.empty()) std::memcpy(turning.data(), corrections.own.data(), corrections.own.size());
  if (!kept->header.corrected()) {
    normals = computed_normals(kept->sites, xyz);
  } else {
    normals =
        turned_normals(kept->sites, xyz, kept->header.in_groups() ? turning : kept->corrections);
  }
  out.bytes = 3 * sizeof(float);
  out.own.resize(normals.size() * sizeof(float));
  if (!out.own.empty()) std::memcpy(out.own.data(), normals.data(), out.own.size());
  out.numbers = out.own;
  out.attribute = kept;
  out.site_of = kept->surface.of_element;
  return {};
}

Status AttributeStore::get(const AttributeChunk& wanted, const ReferenceChunk& reference,
                           std::shared_ptr<const KeptAttribute>& out) {
  const std::pair key(wanted.header.shot, wanted.header.index);
  if (const auto at = kept_.find(key); at != kept_.end()) {
    out = at->second;
    return {};
  }
  std::shared_ptr<const OpenShot> shot;
  if (Status s = groups_.get_shot(reference, stop_, shot); !s.ok()) return s;
  auto kept = std::make_shared<KeptAttribute>();
  AttributeChunk chunk;
  std::vector<uint8_t> buffer;
  if (Status s = load(wanted, buffer, chunk, kept->lease); !s.ok()) return s;
  const Connectivity& faces = shot->faces->connectivity;
  if (Status s = grow(attribute_memory(chunk.header, faces), kept->lease); !s.ok()) return s;
  const DecodedSurface& s = shot->surface;
  const ShotSurface surface{faces, output_grid(s.surface.grid, s.surface.order, s.output)};
  kept->header = chunk.header;
  if (Status status = chunk.header.animated()
                          ? open_sites(chunk, surface, *kept)
                          : decode_static_attribute(chunk, surface, stop_, kept->attribute);
      !status.ok())
    return status;
  kept->lease.shrink(kept->bytes());
  out = kept;
  kept_[key] = std::move(kept);
  return {};
}

Status AttributeStore::decode_group(const std::shared_ptr<const KeptAttribute>& kept,
                                    const AttributeGroupChunk& wanted, unsigned threads,
                                    const StopToken& stop, KeptAttributeGroup& out) {
  AttributeGroupChunk chunk;
  std::vector<uint8_t> buffer;
  if (Status s = load(wanted, buffer, chunk, out.lease); !s.ok()) return s;
  AttributeGroupParts parts;
  if (Status s = read_attribute_group(kept->header, chunk, parts); !s.ok()) return s;
  const uint64_t sites = kept->surface.surface.output.size();
  for (const GroupChunk& part : parts.parts) {
    if (Status s = check_elements(part.header, sites); !s.ok()) return s;
  }
  if (Status s = grow(parts.memory(sites), out.lease); !s.ok()) return s;
  if (Status s = decode_attribute_group(parts, kept->surface, threads, stop, out.frames); !s.ok())
    return s;
  out.lease.shrink(parts.kept(sites));
  out.offset = wanted.offset;
  out.attribute = kept;
  return {};
}

Status AttributeStore::get_frame(const std::shared_ptr<const KeptAttribute>& kept,
                                 const AttributeGroupChunk& chunk, uint32_t t, unsigned threads,
                                 const StopToken& stop, SiteNumbers& out) {
  std::shared_ptr<const KeptAttributeGroup> group = groups_kept_[chunk.header.index];
  if (group == nullptr || group->offset != chunk.offset) {
    group.reset();
    groups_kept_.erase(chunk.header.index);
    auto decoded = std::make_shared<KeptAttributeGroup>();
    if (Status s = decode_group(kept, chunk, threads, stop, *decoded); !s.ok()) return s;
    group = decoded;
    groups_kept_[chunk.header.index] = std::move(decoded);
  }
  const KeptAttribute& attribute = *group->attribute;
  out = {};
  out.bytes = attribute.header.coded_channels() * size_of(attribute.header.type);
  const uint64_t sites = attribute.surface.surface.output.size();
  if (Status s = grow(sites * (out.bytes + 3 * sizeof(float)), out.lease); !s.ok()) return s;
  out.own = attribute_frame(attribute.header, attribute.surface, group->frames, t);
  out.numbers = out.own;
  out.attribute = group->attribute;
  out.site_of = attribute.surface.of_element;
  return {};
}

Status AttributeStore::copy_resource(const ResourceChunk& wanted, std::span<uint8_t> buffer,
                                     size_t& length) {
  ResourceChunk chunk;
  std::vector<uint8_t> loaded;
  Lease lease;
  if (Status s = load(wanted, loaded, chunk, lease); !s.ok()) return s;
  length = chunk.bytes.size();
  std::copy_n(chunk.bytes.begin(), std::min(length, buffer.size()), buffer.begin());
  return {};
}

Status AttributeStore::get_resource(const ResourceChunk& wanted, Resource& out) {
  ResourceChunk chunk;
  std::vector<uint8_t> buffer;
  Lease lease;
  if (Status s = load(wanted, buffer, chunk, lease); !s.ok()) return s;
  out = {chunk.header.name, chunk.header.media_type, {chunk.bytes.begin(), chunk.bytes.end()}};
  return {};
}

}  // namespace reeb
