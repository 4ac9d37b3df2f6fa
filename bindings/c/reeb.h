/**
 * @file reeb.h
 * Decoder of `.reeb` files, animated triangle meshes, as a C99 library.
 *
 *     reeb_decoder *decoder;
 *     reeb_open_memory(bytes, size, NULL, &decoder);
 *     reeb_info info = {.struct_size = sizeof info};
 *     reeb_get_info(decoder, &info);
 *     reeb_target target = {.struct_size = sizeof target};
 *     target.positions = malloc(3 * sizeof(float) * info.max_vertices);
 *     target.vertex_capacity = info.max_vertices;
 *     for (uint32_t frame = 0; frame < info.frame_count; ++frame)
 *       if (reeb_get_frame(decoder, frame, &target) == REEB_OK) ...
 *     reeb_close(decoder);
 *
 * **Bytes may be hostile.** Whatever they are, a call returns, and memory and time stay within the
 * limits of the options. Decoded positions are the same to the bit on every machine.
 *
 * **Threads.** Calls on one decoder may come from any thread; they take turns. reeb_cancel does not
 * wait for its turn; reeb_close must be the last call, with no other running. Decoders know nothing
 * of each other, and the library has no global state.
 *
 * **Floating point.** Every call, and every thread of the library, sets the state of the processor
 * that it needs - rounding to nearest, subnormals kept, no traps - and puts the caller's back, also
 * where it fails. Callbacks run in the library's state.
 *
 * **Structs** start with `struct_size`, which the caller sets to its sizeof; later versions of the
 * library only add members at the end, and 0 is their default.
 *
 * Frames, shots and groups are counted from 0. Pointers that a call gives out live as long as the
 * decoder, unless it says otherwise.
 */
#ifndef REEB_H
#define REEB_H

#include <stddef.h>
#include <stdint.h>

#include "reeb_version.h"

#if defined(_WIN32)
#define REEB_API
#else
#define REEB_API __attribute__((visibility("default")))
#endif

#ifdef __cplusplus
extern "C" {
#endif

/** How a call ended. Values never change their meaning. */
typedef enum reeb_result {
  REEB_OK = 0,
  REEB_INVALID_ARGUMENT = 1, /**< a pre-condition is broken: a null pointer, a frame past the end */
  REEB_CORRUPT = 2,          /**< the bytes break the format, or what is asked for is damaged */
  REEB_TRUNCATED = 3,        /**< the file ends before its first header does */
  REEB_UNSUPPORTED = 4,      /**< a newer format version, or an unknown critical chunk */
  REEB_LIMIT_EXCEEDED = 5,   /**< it takes more than the limits of the options allow */
  REEB_IO = 6,               /**< a callback failed */
  REEB_CANCELLED = 7,        /**< by reeb_cancel */
  REEB_OUT_OF_MEMORY = 8,    /**< an allocation failed; the decoder stays usable */
  REEB_NEED_MORE_DATA = 9    /**< the bytes pushed so far do not reach it */
} reeb_result;

/** A short English name of a result, never NULL; "unknown result" for any other integer. */
REEB_API const char* reeb_result_string(int result);

/** Version of the library in use: major * 1000000 + minor * 1000 + patch. */
REEB_API uint32_t reeb_version(void);
/** The same as text, "1.2.3". */
REEB_API const char* reeb_version_string(void);
/** The format version that it reads. */
REEB_API uint32_t reeb_format_version(void);

/** An open stream. */
typedef struct reeb_decoder reeb_decoder;

/** What a stream may ask for; 0 = the default. */
typedef struct reeb_limits {
  uint32_t max_vertices; /**< per shot; 16,777,216 */
  uint32_t max_faces;    /**< per shot; 33,554,432 */
  uint32_t max_frames;   /**< of the sequence; 1,048,576 */
  uint64_t max_memory;   /**< bytes that the decoder may hold at once; 4 GiB */
} reeb_limits;

/** Where the decoder's own blocks come from: the handle, pushed bytes, faces, frames in between.
 * What a group takes while it is decoded comes from C++ `operator new`, which a program may
 * replace; all of it counts for `max_memory`. Any thread of the decoder may call. */
typedef struct reeb_allocator {
  void* (*allocate)(void* user, size_t size); /**< aligned as by malloc; NULL where there is none */
  void (*release)(void* user, void* block);
  void* user;
} reeb_allocator;

typedef enum reeb_log_level {
  REEB_LOG_WARNING = 0, /**< the file is damaged or truncated, but opens */
  REEB_LOG_ERROR = 1    /**< why a call failed */
} reeb_log_level;

/** One line of English, without an end of line, valid during the call. */
typedef void (*reeb_log)(void* user, reeb_log_level level, const char* message);

/** All members 0 is the default, but for `struct_size`. */
typedef struct reeb_options {
  size_t struct_size;
  reeb_limits limits;
  /** Threads to decode a group with; 0 = 1. Results do not depend on it. */
  uint32_t threads;
  /** Not 0: the next group is decoded on a thread of its own while frames are asked for in
   * sequence, forwards or backwards, so that playing does not stall. */
  int prefetch;
  /** Bytes of decoded groups to keep, the least recently used go first; 0 = 256 MiB, 1 = none but
   * the group in use and the one decoded ahead, which are kept in any case. */
  uint64_t cache_bytes;
  /** `allocate` NULL: malloc and free. */
  reeb_allocator allocator;
  /** NULL: nothing is said. Called by the thread whose call failed. */
  reeb_log log;
  void* log_user;
  /** Why opening failed, when there is no decoder to ask: a sentence, cut to `message_size` bytes
   * with its closing 0; empty after success. NULL: not wanted. Used during the opening call only.
   */
  char* message;
  size_t message_size;
} reeb_options;

/** Looks at the first bytes of a file: REEB_OK where this library reads it, REEB_NEED_MORE_DATA for
 * fewer than 8 bytes that may be the start of one, REEB_UNSUPPORTED for another format version,
 * REEB_CORRUPT for anything else. */
REEB_API reeb_result reeb_probe(const void* bytes, size_t size);

/** Opens a file in memory, which must outlive the decoder, and checks all of it. `options` NULL:
 * the defaults, here and below. */
REEB_API reeb_result reeb_open_memory(const void* bytes, size_t size, const reeb_options* options,
                                      reeb_decoder** decoder);

/** A file that is read when bytes are needed. Calls come one at a time, from any thread. */
typedef struct reeb_reader {
  uint64_t size; /**< of the file, bytes */
  /** Copies `size` bytes from `offset` on; 0 = done, else the call that needs them ends with
   * REEB_IO. */
  int (*read_at)(void* user, uint64_t offset, void* buffer, size_t size);
  void* user;
} reeb_reader;

/** Opens a file through a callback. Only headers are read; each group when it is needed, where
 * damage is found, too. */
REEB_API reeb_result reeb_open_reader(const reeb_reader* reader, const reeb_options* options,
                                      reeb_decoder** decoder);

/** Opens a file whose bytes are to come by reeb_push. */
REEB_API reeb_result reeb_open_push(const reeb_options* options, reeb_decoder** decoder);
/** Adds bytes at the end and keeps a copy. Frames can be had as soon as their group is whole. */
REEB_API reeb_result reeb_push(reeb_decoder* decoder, const void* bytes, size_t size);
/** Says that there are no more bytes: what is not there counts as cut off from now on. */
REEB_API reeb_result reeb_push_end(reeb_decoder* decoder);

/** Ends the decoder; NULL does nothing. */
REEB_API void reeb_close(reeb_decoder* decoder);

/** What the stream holds. Of pushed bytes: so far. */
typedef struct reeb_info {
  size_t struct_size;
  uint32_t format_version;
  uint32_t frame_count;  /**< up to the last frame that can be decoded */
  uint32_t total_frames; /**< of the sequence as it was encoded */
  uint32_t shot_count;   /**< runs of frames with one connectivity */
  uint32_t group_count;  /**< runs of frames that decode on their own */
  uint32_t metadata_count;
  uint32_t gap_count;    /**< runs of frames that are damaged or cut off, see reeb_get_gap */
  uint32_t max_vertices; /**< of any shot */
  int truncated;         /**< not 0: the file ends early */
  double frame_rate;     /**< frames per second; 0 where unknown */
  double start_time;     /**< of the first frame, in frames */
  uint64_t file_bytes;
} reeb_info;

/** REEB_NEED_MORE_DATA before the sequence header is there. */
REEB_API reeb_result reeb_get_info(reeb_decoder* decoder, reeb_info* info);

typedef struct reeb_shot {
  size_t struct_size;
  uint32_t first_frame;
  uint32_t frame_count; /**< that can be decoded: fewer than its span where there are gaps */
  uint32_t vertex_count;
  uint32_t face_count;
  int order_kept;     /**< not 0: vertices come in the order of the file that was encoded */
  uint32_t end_frame; /**< one past its last frame that can be decoded */
} reeb_shot;

REEB_API reeb_result reeb_get_shot(reeb_decoder* decoder, uint32_t shot, reeb_shot* out);

typedef struct reeb_group {
  size_t struct_size;
  uint32_t first_frame;
  uint32_t frame_count;
  uint32_t shot;
  uint32_t component_count; /**< temporal components */
  uint32_t region_count;    /**< of the affine motion model */
  uint64_t bytes;           /**< in the file */
} reeb_group;

REEB_API reeb_result reeb_get_group(reeb_decoder* decoder, uint32_t group, reeb_group* out);

/** Frames that cannot be decoded, as far as is known without trying. */
REEB_API reeb_result reeb_get_gap(reeb_decoder* decoder, uint32_t gap, uint32_t* first_frame,
                                  uint32_t* frame_count);

/** Key and value, UTF-8. Of pushed bytes, valid until the next push. */
REEB_API reeb_result reeb_get_metadata(reeb_decoder* decoder, uint32_t index, const char** key,
                                       const char** value);
/** The value of a key such as "name"; NULL where there is none. */
REEB_API const char* reeb_find_metadata(reeb_decoder* decoder, const char* key);

/** Triangles of the shot that holds `frame`, three vertices each; every polygon is a fan around its
 * first corner. */
REEB_API reeb_result reeb_get_triangles(reeb_decoder* decoder, uint32_t frame,
                                        const uint32_t** indices, size_t* triangle_count);

/** Polygons of the shot that holds `frame`: the number of corners of each, and the vertices of all
 * corners, one face after another. Any of the pointers may be NULL. */
REEB_API reeb_result reeb_get_polygons(reeb_decoder* decoder, uint32_t frame,
                                       const uint32_t** face_sizes, size_t* face_count,
                                       const uint32_t** corners, size_t* corner_count);

/** Where a frame goes. Vertex v is written to `positions + v * position_stride`; nothing beside its
 * three floats is touched. */
typedef struct reeb_target {
  size_t struct_size;
  float* positions;
  size_t position_stride; /**< floats from one vertex to the next, at least 3; 0 = 3 */
  float* normals;         /**< unit length, area-weighted, (0, 0, 0) at a vertex without a face that
                             has an area; NULL = not wanted */
  size_t normal_stride;   /**< as position_stride */
  size_t vertex_capacity; /**< vertices that there is room for; a frame with more is refused */
} reeb_target;

/** Decodes a frame, in any order; costs one group at most. */
REEB_API reeb_result reeb_get_frame(reeb_decoder* decoder, uint32_t frame,
                                    const reeb_target* target);

/** The pose between two frames, linear: `position` in frames, 0 .. frame_count - 1; the earlier
 * frame where the connectivity changes between them. */
REEB_API reeb_result reeb_get_between(reeb_decoder* decoder, double position,
                                      const reeb_target* target);

/** The position that belongs to `seconds` after the first frame, for reeb_get_between: held at the
 * ends, or around and around if `loop` is not 0; the last frame of a loop goes before its first,
 * and lasts as long as any. REEB_INVALID_ARGUMENT where the frame rate is unknown. */
REEB_API reeb_result reeb_position_of_time(reeb_decoder* decoder, double seconds, int loop,
                                           double* position);

/** With prefetch: tells that the first frame follows the last, and the other way round. */
REEB_API void reeb_set_loop(reeb_decoder* decoder, int loop);

/** Ends the calls that other threads have running with REEB_CANCELLED, soon. Later calls run. */
REEB_API void reeb_cancel(reeb_decoder* decoder);

/** How playing went since opening or reeb_reset_stats. */
typedef struct reeb_stats {
  size_t struct_size;
  uint64_t frames;              /**< given */
  uint64_t groups_decoded;      /**< in all */
  uint64_t groups_ahead;        /**< of these, on the thread that decodes ahead */
  double longest_stall;         /**< seconds that the slowest frame took */
  uint32_t longest_stall_frame; /**< which one */
  uint64_t memory;              /**< bytes accounted for now */
  uint64_t peak_memory;         /**< the most since opening */
} reeb_stats;

REEB_API reeb_result reeb_get_stats(reeb_decoder* decoder, reeb_stats* stats);
REEB_API void reeb_reset_stats(reeb_decoder* decoder);

/** Copies a sentence about the last failed call on this decoder, of any thread (reeb_options has
 * one about a failed opening), to `buffer`, cut to
 * `size` bytes with its closing 0; returns the length of all of it, 0 where no call failed. */
REEB_API size_t reeb_get_message(reeb_decoder* decoder, char* buffer, size_t size);

#ifdef __cplusplus
}
#endif

#endif
