// Where a cone takes its samples; lengths in voxels.

layout(std430, binding = 11) readonly buffer Schedules { float schedules[]; };  // MAX_STEPS rows of 10 a schedule
uniform vec3 origin;
uniform float voxelSize;
uniform int lightCount;

struct Step {
    float middle, begin, end, diameter, level, tapWidth, readVoxels, settled, taps, firstTap;
};

Step stepOf(int schedule, int index)
{
    int i = 10 * (schedule * MAX_STEPS + index);
    Step s = Step(schedules[i], schedules[i + 1], schedules[i + 2], schedules[i + 3], schedules[i + 4], schedules[i + 5], schedules[i + 6], schedules[i + 7], schedules[i + 8],
                  schedules[i + 9]);
#ifdef PLANT_level_off_by_one
    s.level += 1.0;
#endif
    return s;
}
