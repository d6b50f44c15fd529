// From the picture back into the scene.
uniform mat4 camera_to_world;
uniform vec4 lens;  // x, y: half the picture at depth 1; z, w: its middle, moved by the place in the pixel

vec3 view_place(vec2 uv, float depth) { return vec3((2.0 * uv - 1.0 + lens.zw) * lens.xy * depth, -depth); }

vec3 world_direction(vec2 uv) { return normalize(mat3(camera_to_world) * view_place(uv, 1.0)); }

vec3 world_place(vec2 uv, float depth) { return (camera_to_world * vec4(view_place(uv, depth), 1.0)).xyz; }
