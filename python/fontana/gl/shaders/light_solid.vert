uniform mat4 light_matrix;  // world to clip space
uniform vec3 centre;
in vec3 in_position;

void main() { gl_Position = light_matrix * vec4(in_position + centre, 1.0); }
