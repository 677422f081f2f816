// A triangle turned so that its normal's longest component looks along the depth of an n x n picture, one pixel a column of voxels.

layout(std430, binding = 0) readonly buffer Positions { float positions[]; };
layout(std430, binding = 1) readonly buffer Triangles { uint triangles[]; };
uniform vec3 origin;
uniform float voxelSize;
uniform int resolution;

flat out dvec3 planeNormal, corner;  // of the projected triangle: column, row, depth
flat out ivec2 touchedDepths;
flat out int depthAxis;

// In voxels, on the lattice of 1/4096.
dvec3 corner_(int k)
{
    uint i = 3u * triangles[(gl_VertexID / 3) * 3 + k];
    dvec3 world = dvec3(positions[i], positions[i + 1u], positions[i + 2u]);
    return floor((world - dvec3(origin)) * (1.0lf / double(voxelSize)) * 4096.0lf + 0.5lf) / 4096.0lf;
}

dvec3 turned(dvec3 v) { return depthAxis == 2 ? v.xyz : depthAxis == 1 ? v.xzy : v.yzx; }

void main()
{
    dvec3 p[3] = dvec3[3](corner_(0), corner_(1), corner_(2));
    dvec3 normal = cross(p[1] - p[0], p[2] - p[0]), size = abs(normal);
    depthAxis = size.z >= size.x && size.z >= size.y ? 2 : size.y >= size.x ? 1 : 0;

    planeNormal = turned(normal);
    corner = turned(p[0]);
    double a = corner.z, b = turned(p[1]).z, c = turned(p[2]).z;
    touchedDepths = ivec2(max(int(ceil(min(a, min(b, c)))) - 1, 0), min(int(floor(max(a, max(b, c)))), resolution - 1));

    dvec2 at = turned(p[gl_VertexID % 3]).xy;
    gl_Position = vec4(2.0 * float(at.x) / float(resolution) - 1.0, 2.0 * float(at.y) / float(resolution) - 1.0, 0.5, 1.0);
}
