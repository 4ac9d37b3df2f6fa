// Headers of what a mesh carries beside positions: attributes, their values in a group of frames,
// resources, bounds. Described once, as those in `headers.h`; fields are those of
// `spec/attributes.md`.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "bitstream/attribute_kinds.h"
#include "bitstream/headers.h"

namespace reeb {

/// Front of chunk `attr`; the body follows, see AttributeBody.
struct AttributeHeader {
  static constexpr uint8_t kAnimated = 1;   ///< values for every frame, in the groups' chunks
  static constexpr uint8_t kComputed = 2;   ///< normals that follow from positions; animated
  static constexpr uint8_t kCorrected = 4;  ///< computed ones are turned by corrections
  static constexpr uint8_t kTurning = 8;    ///< which differ from frame to frame
  uint32_t shot = 0;
  uint32_t index = 0;  ///< among the attributes of its shot
  std::string name;
  Semantic semantic = Semantic::kGeneric;
  Domain domain = Domain::kVertex;
  ValueType type = ValueType::kBinary32;
  uint32_t channel_count = 1;
  uint8_t flags = 0;

  bool animated() const { return (flags & kAnimated) != 0; }
  bool computed() const { return (flags & kComputed) != 0; }
  bool corrected() const { return (flags & kCorrected) != 0; }
  /// True where the groups have chunks of it.
  bool in_groups() const { return (flags & (computed() ? kTurning : kAnimated)) != 0; }
  /// Channels that are coded: those of the corrections, of computed normals.
  uint32_t coded_channels() const { return !computed() ? channel_count : corrected() ? 2 : 0; }
  /// True where nothing of it may stand in the way of computing.
  bool may_be_computed() const {
    return semantic == Semantic::kNormal && type == ValueType::kBinary32 && channel_count == 3 &&
           (domain == Domain::kVertex || domain == Domain::kCorner);
  }
  bool operator==(const AttributeHeader&) const = default;
};

template <class V>
void describe(V& v, AttributeHeader& h) {
  v.uv("shot", h.shot, 0, kMaxUint32);
  v.uv("index", h.index, 0, kMaxAttributes - 1);
  v.text("name", h.name);
  if (h.name.size() > kMaxAttributeName) v.fail("name", "is longer than 256 bytes");
  v.u8("semantic", h.semantic, 0, kLastSemantic);
  v.u8("domain", h.domain, 0, 3);
  v.u8("type", h.type, 0, kLastValueType);
  v.u8("channel_count", h.channel_count, 1, kMaxChannels);
  v.flags("flags", h.flags,
          AttributeHeader::kAnimated | AttributeHeader::kComputed | AttributeHeader::kCorrected |
              AttributeHeader::kTurning);
  const bool turning = (h.flags & AttributeHeader::kTurning) != 0;
  if ((h.computed() && !(h.animated() && h.may_be_computed())) ||
      (h.corrected() && !h.computed()) || (turning && !h.corrected()))
    v.fail("flags", "asks for what cannot be computed");
}

/// The numbers that a channel's integers stand for.
struct ChannelHeader {
  static constexpr double kMaxNumber = std::numeric_limits<float>::max();
  /// n stands for (low + n) * step; else, the bits of a binary32 in order.
  enum class Numbers : uint8_t { kMultiples = 0, kBinary32 = 1 };
  Numbers numbers = Numbers::kMultiples;
  uint64_t low_folded = 0;  ///< low of n = 0: 2 low, or -2 low - 1 where it is negative
  double step = 1;
  uint64_t top = 0;  ///< largest n

  int64_t low() const {
    const auto half = static_cast<int64_t>(low_folded >> 1);
    return (low_folded & 1) != 0 ? -half - 1 : half;
  }
  void set_low(int64_t low) {
    low_folded =
        low < 0 ? 2 * static_cast<uint64_t>(-(low + 1)) + 1 : 2 * static_cast<uint64_t>(low);
  }
  bool operator==(const ChannelHeader&) const = default;
};

template <class V>
void describe(V& v, ChannelHeader& h) {
  v.u8("numbers", h.numbers, 0, 1);
  v.uv("low_folded", h.low_folded, 0, uint64_t{1} << 41);
  v.f64("step", h.step, std::numeric_limits<double>::min(), ChannelHeader::kMaxNumber);
  v.uv("top", h.top, 0, kMaxUint32);
}

/// A name in a table.
struct NameEntry {
  std::string name;
  bool operator==(const NameEntry&) const = default;
};

template <class V>
void describe(V& v, NameEntry& h) {
  v.text("name", h.name);
}

/// Behind the front of chunk `attr`; the section of values follows and fills the rest.
struct AttributeBody {
  std::vector<NameEntry> names;         ///< that indices stand for, in the order of the source
  std::vector<ChannelHeader> channels;  ///< one each; of animated attributes, none
  bool operator==(const AttributeBody&) const = default;
};

template <class V>
void describe(V& v, AttributeBody& h) {
  v.list("name_count", h.names, 1);
  v.list("channel_headers", h.channels, 4);
}

/// Front of chunk `agrp`: an animated attribute in the frames of a group.
struct AttributeGroupHeader {
  uint32_t shot = 0;
  uint32_t index = 0;  ///< of the attribute
  uint32_t first_frame = 0;
  uint32_t frame_count = 1;
  bool operator==(const AttributeGroupHeader&) const = default;
};

template <class V>
void describe(V& v, AttributeGroupHeader& h) {
  v.uv("shot", h.shot, 0, kMaxUint32);
  v.uv("index", h.index, 0, kMaxAttributes - 1);
  v.uv("first_frame", h.first_frame, 0, kMaxUint32);
  v.uv("frame_count", h.frame_count, 1, kMaxGroupFrames);
}

/// Front of chunk `rsrc`; the bytes follow and fill the rest.
struct ResourceHeader {
  std::string name;
  std::string media_type;
  bool operator==(const ResourceHeader&) const = default;
};

template <class V>
void describe(V& v, ResourceHeader& h) {
  v.text("name", h.name);
  if (h.name.size() > kMaxAttributeName) v.fail("name", "is longer than 256 bytes");
  v.text("media_type", h.media_type);
  if (h.media_type.size() > kMaxMediaType) v.fail("media_type", "is longer than 128 bytes");
}

/// A box that holds all decoded positions of some frames; corners rounded outwards, if at all.
struct Box {
  float low[3] = {0, 0, 0};
  float high[3] = {0, 0, 0};
  bool operator==(const Box&) const = default;
};

inline constexpr size_t kBoxBytes = 24;

template <class V>
void describe(V& v, Box& h) {
  constexpr double kMaxFloat = std::numeric_limits<float>::max();
  v.f32("low_x", h.low[0], -kMaxFloat, kMaxFloat);
  v.f32("low_y", h.low[1], -kMaxFloat, kMaxFloat);
  v.f32("low_z", h.low[2], -kMaxFloat, kMaxFloat);
  v.f32("high_x", h.high[0], -kMaxFloat, kMaxFloat);
  v.f32("high_y", h.high[1], -kMaxFloat, kMaxFloat);
  v.f32("high_z", h.high[2], -kMaxFloat, kMaxFloat);
}

/// Chunk `bnds`: a box for each group, in order of frames.
struct GroupBoxes {
  std::vector<Box> groups;
  bool operator==(const GroupBoxes&) const = default;
};

template <class V>
void describe(V& v, GroupBoxes& h) {
  v.list("group_count", h.groups, kBoxBytes);
}

}  // namespace reeb
