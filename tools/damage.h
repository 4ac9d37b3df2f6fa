// Damaged and truncated `.reeb` files: what can be had is had, and what is missing is said.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>
#include <vector>

#include "codec/dec/decoder.h"
#include "tools/console.h"
#include "tools/io/read_sequence.h"

namespace reeb::tools {

/// --keep-going.
void add_keep_going_option(CLI::App& command, bool& keep_going);

/// "NAME: frames 5 to 8 of 20 are damaged or cut off"; empty where `missing` is.
std::string describe_missing(const std::string& name, const std::vector<StreamInfo::Gap>& missing,
                             uint32_t total_frames);

/// "bytes 11 to 40 (attr) are damaged".
std::string describe(const DamagedRange& range);

/// The frames that are missing, and what else of the file is damaged or cut off; empty where it is
/// whole.
std::string describe_damage(const std::string& name, const StreamInfo& info,
                            const std::vector<StreamInfo::Gap>& missing);

/// The same of an input, which may be no stream.
std::string describe_damage(const std::string& name, const ReadReport& report);

/// Says that something is missing and gives the exit code of a command that did the rest.
int finish_damaged(Console& console, const std::string& what, bool keep_going);

/// Decodes a frame of every group, and gives the frames that cannot be had. Fails where that has
/// another reason than damage.
Status find_missing(Decoder& decoder, const std::function<void(double)>& progress,
                    std::vector<StreamInfo::Gap>& missing);

/// The frames outside of `missing`, numbers from 1.
std::vector<uint32_t> present_frames(const std::vector<StreamInfo::Gap>& missing,
                                     uint32_t total_frames);

}  // namespace reeb::tools
