/**
 * @file reeb_attributes.h
 * What a `.reeb` file carries beside positions: attributes, which are values at vertices, corners
 * of faces, faces or the shot; tables of names; resources; bounds. And the mesh as graphics
 * interfaces take it:
 *
 *     uint32_t normals, uvs;
 *     reeb_find_semantic(decoder, 0, REEB_SEMANTIC_NORMAL, &normals);
 *     reeb_find_semantic(decoder, 0, REEB_SEMANTIC_TEXTURE_COORDINATE, &uvs);
 *     const uint32_t split_by[] = {normals, uvs};
 *     reeb_render_mesh *mesh;
 *     reeb_make_render_mesh(decoder, 0, split_by, 2, &mesh);
 *     reeb_render_info info = {.struct_size = sizeof info};
 *     reeb_get_render_info(mesh, &info);
 *     ... upload info.indices, and uvs by reeb_get_render_values, once
 *     ... every frame: positions by reeb_get_render_frame, normals by reeb_get_render_values
 *     reeb_free_render_mesh(mesh);
 *
 * Calls, structs, threads and pointers are as in reeb.h. `frame` of a call that gives what is the
 * same in all frames of a shot is any of them. Damage to an attribute makes calls about it end with
 * REEB_CORRUPT or, where nothing of it is left, REEB_INVALID_ARGUMENT; frames are not touched by
 * it. What calls here take comes from `operator new` and counts for `max_memory`.
 */
#ifndef REEB_ATTRIBUTES_H
#define REEB_ATTRIBUTES_H

#include "reeb.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What values mean. */
typedef enum reeb_semantic {
  REEB_SEMANTIC_GENERIC = 0,
  REEB_SEMANTIC_TEXTURE_COORDINATE = 1,
  REEB_SEMANTIC_NORMAL = 2,
  REEB_SEMANTIC_TANGENT = 3,
  REEB_SEMANTIC_COLOUR = 4,
  REEB_SEMANTIC_VELOCITY = 5,
  REEB_SEMANTIC_MATERIAL = 6, /**< index in the attribute's table of names */
  REEB_SEMANTIC_GROUP = 7,    /**< the same */
  REEB_SEMANTIC_INDEX = 8     /**< of corners: place of their value in a list of the source */
} reeb_semantic;

/** What there is one value of: the elements of an attribute, in the order of the shot's mesh. */
typedef enum reeb_domain {
  REEB_DOMAIN_VERTEX = 0,
  REEB_DOMAIN_CORNER = 1, /**< faces one after another, as of reeb_get_polygons */
  REEB_DOMAIN_FACE = 2,
  REEB_DOMAIN_SHOT = 3
} reeb_domain;

typedef enum reeb_value_type {
  REEB_TYPE_BINARY32 = 0,
  REEB_TYPE_U8 = 1,
  REEB_TYPE_U16 = 2,
  REEB_TYPE_I32 = 3,
  REEB_TYPE_U8_NORMALISED = 4, /**< n stands for n / 255 */
  REEB_TYPE_U16_NORMALISED = 5 /**< n stands for n / 65535 */
} reeb_value_type;

typedef struct reeb_attribute {
  size_t struct_size;
  uint32_t shot;
  uint32_t index;    /**< among the attributes of its shot: what calls about it take */
  const char* name;  /**< UTF-8, as the source says */
  uint32_t semantic; /**< a reeb_semantic */
  uint32_t domain;   /**< a reeb_domain */
  uint32_t type;     /**< a reeb_value_type */
  uint32_t channels; /**< numbers per element, 1 .. 16 */
  int animated;      /**< not 0: values differ from frame to frame */
  int computed;      /**< not 0: normals that follow from the positions of each frame */
  uint64_t bytes;    /**< in the file */
} reeb_attribute;

/** How many attributes all shots have, those left out whose headers are damaged. */
REEB_API reeb_result reeb_get_attribute_count(reeb_decoder* decoder, uint32_t* count);
/** Number `number` of these, shot after shot. Of pushed bytes, pointers are valid until the next
 * push, here and below. */
REEB_API reeb_result reeb_get_attribute(reeb_decoder* decoder, uint32_t number,
                                        reeb_attribute* out);
/** The index of the first attribute of the shot of `frame` that is called so, or means that;
 * REEB_INVALID_ARGUMENT where there is none. */
REEB_API reeb_result reeb_find_attribute(reeb_decoder* decoder, uint32_t frame, const char* name,
                                         uint32_t* index);
REEB_API reeb_result reeb_find_semantic(reeb_decoder* decoder, uint32_t frame,
                                        reeb_semantic semantic, uint32_t* index);

/** Copies the name that value `entry` of a material or group stands for, cut to `size` bytes with
 * its closing 0; `length`, which may be NULL: of all of it. REEB_INVALID_ARGUMENT past the last
 * entry. */
REEB_API reeb_result reeb_get_name(reeb_decoder* decoder, uint32_t frame, uint32_t index,
                                   uint32_t entry, char* buffer, size_t size, size_t* length);

/** Where values go: element e's channels to `values + e * stride`, numbers of the attribute's type;
 * nothing beside them is touched. */
typedef struct reeb_value_target {
  size_t struct_size;
  void* values;            /**< aligned in any way */
  size_t stride;           /**< bytes from one element to the next; 0 = one after another */
  size_t element_capacity; /**< elements that there is room for; more are refused */
} reeb_value_target;

/** Values of an attribute in a frame. Static ones are decoded once and kept, as memory allows. */
REEB_API reeb_result reeb_get_values(reeb_decoder* decoder, uint32_t frame, uint32_t index,
                                     const reeb_value_target* target);

/** Resources: files that travel along, such as material text and textures. */
REEB_API reeb_result reeb_get_resource_count(reeb_decoder* decoder, uint32_t* count);
/** A resource's file name and media type, UTF-8. */
REEB_API reeb_result reeb_get_resource(reeb_decoder* decoder, uint32_t resource, const char** name,
                                       const char** media_type);
/** Copies its bytes, up to `size` of them; `length`, which may be NULL: all there are. */
REEB_API reeb_result reeb_get_resource_bytes(reeb_decoder* decoder, uint32_t resource, void* buffer,
                                             size_t size, size_t* length);

/** The box that holds all positions of a group. REEB_INVALID_ARGUMENT where the file does not tell.
 * The box of the clip is around those of its groups. */
REEB_API reeb_result reeb_get_bounds(reeb_decoder* decoder, uint32_t group, float low[3],
                                     float high[3]);

/** Frames `first` .. `first + count - 1`, xyz after xyz, each `frame_stride` floats after the one
 * before, which is room for a frame. Sixteen at once take half the time of one after another. */
REEB_API reeb_result reeb_get_frames(reeb_decoder* decoder, uint32_t first, uint32_t count,
                                     float* positions, size_t frame_stride);

/** One vertex for every combination of a vertex and what its corners have, and triangles. */
typedef struct reeb_render_mesh reeb_render_mesh;

/** Of the shot that holds `frame`: split where any of the attributes `split_by` differs at the
 * corners of a vertex (those of other domains split nothing), triangles sorted by the first static
 * material of the faces. Vertices without a face are left out. It lives until
 * reeb_free_render_mesh, which must come before reeb_close. */
REEB_API reeb_result reeb_make_render_mesh(reeb_decoder* decoder, uint32_t frame,
                                           const uint32_t* split_by, size_t split_count,
                                           reeb_render_mesh** mesh);
/** NULL does nothing. */
REEB_API void reeb_free_render_mesh(reeb_render_mesh* mesh);

/** What a render mesh has; pointers live as long as it. */
typedef struct reeb_render_info {
  size_t struct_size;
  uint32_t shot;
  uint32_t vertex_count;
  const uint32_t* source_vertices; /**< vertex of the shot, of each render vertex */
  const uint32_t* source_corners;  /**< a corner that has its values */
  size_t triangle_count;
  const uint32_t* indices;      /**< three render vertices of each triangle */
  const uint32_t* source_faces; /**< of each triangle */
  size_t range_count;           /**< see reeb_get_render_range */
  int64_t material_attribute;   /**< index of what triangles are sorted by; -1: nothing */
} reeb_render_info;

REEB_API reeb_result reeb_get_render_info(const reeb_render_mesh* mesh, reeb_render_info* info);
/** Triangles `first` .. `first + count - 1` are those of value `material`, whose name reeb_get_name
 * has; ranges rise by it. */
REEB_API reeb_result reeb_get_render_range(const reeb_render_mesh* mesh, size_t range,
                                           int64_t* material, size_t* first, size_t* count);

/** A frame of the mesh's shot in its layout: positions and, where wanted, normals that are smooth
 * at every vertex of the shot (those with hard edges are an attribute); `vertex_capacity` counts
 * render vertices. */
REEB_API reeb_result reeb_get_render_frame(reeb_decoder* decoder, uint32_t frame,
                                           const reeb_render_mesh* mesh, const reeb_target* target);
/** The pose between two frames, as of reeb_get_between. */
REEB_API reeb_result reeb_get_render_between(reeb_decoder* decoder, double position,
                                             const reeb_render_mesh* mesh,
                                             const reeb_target* target);
/** Values of an attribute in that layout: of each render vertex, where it is one of vertices or
 * corners; of each triangle, where it is one of faces. */
REEB_API reeb_result reeb_get_render_values(reeb_decoder* decoder, uint32_t frame, uint32_t index,
                                            const reeb_render_mesh* mesh,
                                            const reeb_value_target* target);

#ifdef __cplusplus
}
#endif

#endif
