// One voxel a fragment: where the triangle's plane meets the centre of the column.

layout(std430, binding = 2) buffer Bits { uint words[]; };
uniform int resolution;

flat in dvec3 planeNormal, corner;
flat in ivec2 touchedDepths;
flat in int depthAxis;

void main()
{
    ivec2 column = ivec2(gl_FragCoord.xy);
    dvec2 from = corner.xy - (dvec2(column) + 0.5lf);
    double depth = corner.z + (planeNormal.x * from.x + planeNormal.y * from.y) / planeNormal.z;
#ifdef PLANT_voxel_depth
    depth += 0.5lf;  // rounded to the nearest, not down
#endif
    int k = int(floor(depth));
    if (k < touchedDepths.x || k > touchedDepths.y) return;

    ivec3 voxel = depthAxis == 2 ? ivec3(column, k) : depthAxis == 1 ? ivec3(column.x, k, column.y) : ivec3(k, column);
    int rowBytes = (resolution + 7) / 8;
    int byte_ = (voxel.z * resolution + voxel.y) * rowBytes + voxel.x / 8;
    atomicOr(words[byte_ >> 2], 1u << (8 * (byte_ & 3) + (voxel.x & 7)));
}
