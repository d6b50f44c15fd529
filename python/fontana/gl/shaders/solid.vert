uniform mat4 view, projection;
uniform vec3 centre;
in vec3 in_position;
in vec3 in_normal;
out vec3 place, local, normal;
out float view_depth;

void main() {
    local = in_position;
    place = in_position + centre;
    normal = in_normal;
    vec4 seen = view * vec4(place, 1.0);
    view_depth = -seen.z;
    gl_Position = projection * seen;
}
