/* Passes of the remesher over whole meshes, each the same as the numpy code beside which it is called.

Every number is made by the same operations in the same order as there, so that both give the same mesh: compile
without contraction of a * b + c and without fast-math (hatch_build.py does). Nothing is allocated here: arrays come
from the caller, whole numbers are 64 bits, truth values one byte.

    n vertices, m faces, e edges; points (n, 3); faces (m, 3); half-edge 3 f + k runs from corner k of face f to k + 1
*/

#include <math.h>
#include <stdint.h>

#ifdef _WIN32
#define API __declspec(dllexport)
#else
#define API __attribute__((visibility("default")))
#endif

typedef int64_t Int;
typedef uint8_t Bool;

/* checksum of this file as it was built, which lamella.surface.remesh.kernel compares with the file beside it */
API Int lamella_source(void) { return LAMELLA_SOURCE; }

static Int next_half(Int half) { return half % 3 == 2 ? half - 2 : half + 1; }

static double least(double a, double b) { return a < b ? a : b; }

static double most(double a, double b) { return a > b ? a : b; }

static double dot(const double *a, const double *b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

static void cross(const double *a, const double *b, double *to)
{
    to[0] = a[1] * b[2] - a[2] * b[1];
    to[1] = a[2] * b[0] - a[0] * b[2];
    to[2] = a[0] * b[1] - a[1] * b[0];
}

static void less(const double *a, const double *b, double *to)
{
    for (int i = 0; i < 3; i++) to[i] = a[i] - b[i];
}

static void unit(const double *a, double *to)
{
    double length = sqrt(dot(a, a));
    if (!(length > 0)) length = 1.0;
    for (int i = 0; i < 3; i++) to[i] = a[i] / length;
}

static double distance(const double *a, const double *b)
{
    double way[3];
    less(a, b, way);
    return sqrt(dot(way, way));
}

static void area_vector(const double *a, const double *b, const double *c, double *to)
{
    double one[3], other[3];
    less(b, a, one);
    less(c, a, other);
    cross(one, other, to);
    for (int i = 0; i < 3; i++) to[i] = 0.5 * to[i];
}

/* `shape` of topology.py */
static double shape(const double *a, const double *b, const double *c, const double *area, const double *normal)
{
    double ab[3], bc[3], ca[3];
    less(a, b, ab);
    less(b, c, bc);
    less(c, a, ca);
    double squares = dot(ab, ab) + dot(bc, bc) + dot(ca, ca);
    double facing = dot(area, normal), size = sqrt(dot(area, area));
    double value = facing > 0.5 * size ? size : least(facing, 0.0) - 0.01 * size;
    return 4.0 * sqrt(3.0) * value / (squares > 0 ? squares : 1.0);
}

static double shape_towards(const double *a, const double *b, const double *c, const double *normal)
{
    double area[3];
    area_vector(a, b, c, area);
    return shape(a, b, c, area, normal);
}

/* `grouped` of topology.py: offsets (count + 1), order (k) */
API void lamella_grouped(Int k, const Int *owner, Int count, Int *offsets, Int *order)
{
    for (Int i = 0; i <= count; i++) offsets[i] = 0;
    for (Int i = 0; i < k; i++) offsets[owner[i] + 1]++;
    for (Int i = 0; i < count; i++) offsets[i + 1] += offsets[i];
    for (Int i = 0; i < k; i++) order[offsets[owner[i]]++] = i;
    for (Int i = count; i > 0; i--) offsets[i] = offsets[i - 1];
    offsets[0] = 0;
}

/* `connect` of topology.py: the number of edges, -1 where it raises; offsets (n + 1) and order (3 m) are room to work */
API Int lamella_connect(Int m, Int n, const Int *faces, Int *keys, Int *ends, Int *halves, Int *edge_of_half,
                        Int *offsets, Int *order)
{
    Int edges = 0;
    for (Int i = 0; i <= n; i++) offsets[i] = 0;
    for (Int h = 0; h < 3 * m; h++) {
        Int a = faces[h], b = faces[next_half(h)];
        offsets[(a < b ? a : b) + 1]++;
    }
    for (Int i = 0; i < n; i++) offsets[i + 1] += offsets[i];
    for (Int h = 0; h < 3 * m; h++) {
        Int a = faces[h], b = faces[next_half(h)];
        order[offsets[a < b ? a : b]++] = h;
    }
    for (Int low = 0, first = 0; low < n; first = offsets[low], low++) {
        Int last = offsets[low];
        /* sorted by the higher end, equal ones as they come */
        for (Int i = first + 1; i < last; i++) {
            Int h = order[i], at = i;
            Int high = faces[h] + faces[next_half(h)] - low;
            for (; at > first; at--) {
                Int other = order[at - 1];
                if (faces[other] + faces[next_half(other)] - low <= high) break;
                order[at] = other;
            }
            order[at] = h;
        }
        for (Int i = first; i < last;) {
            Int h = order[i], high = faces[h] + faces[next_half(h)] - low, count = 1;
            while (i + count < last && faces[order[i + count]] + faces[next_half(order[i + count])] - low == high) count++;
            if (count > 2 || (count == 2 && faces[h] != faces[next_half(order[i + 1])])) return -1;
            keys[edges] = low * n + high;
            ends[2 * edges] = faces[h];
            ends[2 * edges + 1] = faces[next_half(h)];
            halves[2 * edges] = h;
            halves[2 * edges + 1] = count == 2 ? order[i + 1] : -1;
            for (Int j = 0; j < count; j++) edge_of_half[order[i + j]] = edges;
            edges++;
            i += count;
        }
    }
    return edges;
}

static void vertex_normals(Int n, Int m, const Int *faces, const double *area, double *at_vertex)
{
    for (Int i = 0; i < 3 * n; i++) at_vertex[i] = 0.0;
    for (Int h = 0; h < 3 * m; h++)
        for (int i = 0; i < 3; i++) at_vertex[3 * faces[h] + i] += area[3 * (h / 3) + i];
    for (Int v = 0; v < n; v++) unit(at_vertex + 3 * v, at_vertex + 3 * v);
}

/* `Draft.face_shapes`: area (m, 3), normals (m, 3), shapes (m); at_vertex (n, 3) is room to work */
API void lamella_face_shapes(Int n, Int m, const double *points, const Int *faces, double bend, double *area,
                             double *normals, double *shapes, double *at_vertex)
{
    for (Int f = 0; f < m; f++) {
        const Int *v = faces + 3 * f;
        area_vector(points + 3 * v[0], points + 3 * v[1], points + 3 * v[2], area + 3 * f);
    }
    vertex_normals(n, m, faces, area, at_vertex);
    for (Int f = 0; f < m; f++) {
        const Int *v = faces + 3 * f;
        double own[3], around[3];
        for (int i = 0; i < 3; i++)
            around[i] = at_vertex[3 * v[0] + i] + at_vertex[3 * v[1] + i] + at_vertex[3 * v[2] + i];
        unit(around, around);
        unit(area + 3 * f, own);
        const double *normal = dot(own, around) > bend ? own : around;
        for (int i = 0; i < 3; i++) normals[3 * f + i] = normal[i];
        shapes[f] = shape(points + 3 * v[0], points + 3 * v[1], points + 3 * v[2], area + 3 * f, normals + 3 * f);
    }
}

/* `star_after` of collapse.py: new, old, longest (k); fans are offsets (n + 1) and half-edges (3 m) */
API void lamella_star_after(Int k, const double *points, const Int *faces, const double *size, const double *normals,
                            const double *shapes, const Int *offsets, const Int *fans, const Int *removed,
                            const Int *kept, const double *target, double *new, double *old, double *longest)
{
    for (Int c = 0; c < k; c++) {
        const double *goal = target + 3 * c;
        new[c] = old[c] = INFINITY;
        longest[c] = 0.0;
        for (int side = 0; side < 2; side++) {
            Int centre = side ? kept[c] : removed[c];
            for (Int i = offsets[centre]; i < offsets[centre + 1]; i++) {
                Int f = fans[i] / 3;
                const Int *v = faces + 3 * f;
                const double *corners[3];
                int goes = 0, stays = 0;
                for (int j = 0; j < 3; j++) {
                    int is_removed = v[j] == removed[c], is_kept = v[j] == kept[c];
                    corners[j] = is_removed || is_kept ? goal : points + 3 * v[j];
                    goes |= is_removed;
                    stays |= is_kept;
                }
                old[c] = least(old[c], shapes[f]);
                if (goes && stays) continue;
                new[c] = least(new[c], shape_towards(corners[0], corners[1], corners[2], normals + 3 * f));
                for (int j = 0; j < 3; j++)
                    longest[c] = most(longest[c], distance(corners[j], goal) / (0.5 * (size[v[j]] + size[kept[c]])));
            }
        }
    }
}

static int is_joined(const Int *offsets, const Int *near, Int one, Int other)
{
    for (Int i = offsets[one]; i < offsets[one + 1]; i++)
        if (near[i] == other) return 1;
    return 0;
}

/* `narrow` of draft.py */
static int is_narrow(const double *points, const double *size, double bridge, Int one, Int other)
{
    return distance(points + 3 * one, points + 3 * other) < bridge * 0.5 * (size[one] + size[other]);
}

/* `link_condition` of collapse.py: allowed (k); offsets (n + 1) and near (2 e) are the vertices' neighbours */
API void lamella_link_condition(Int k, const double *points, const double *size, const Bool *boundary,
                                const Int *offsets, const Int *near, const Int *faces, const Int *halves, double bridge,
                                const Int *edges, const Int *removed, const Int *kept, Bool *allowed)
{
    for (Int c = 0; c < k; c++) {
        Int gone = removed[c], stays = kept[c], common = 0, bridges = 0;
        for (Int i = offsets[gone]; i < offsets[gone + 1]; i++) {
            Int v = near[i];
            if (v == stays) continue;
            if (is_joined(offsets, near, v, stays))
                common++;
            else if (!boundary[gone] && boundary[stays] && boundary[v] && !is_narrow(points, size, bridge, stays, v))
                bridges++;
        }
        int enough = 1, inner = halves[2 * edges[c] + 1] >= 0;
        for (int side = 0; side < 1 + inner; side++) {
            Int apex = faces[next_half(next_half(halves[2 * edges[c] + side]))];
            enough &= offsets[apex + 1] - offsets[apex] >= (boundary[apex] ? 3 : 4);
        }
        allowed[c] = common == (inner ? 2 : 1) && bridges == 0 && enough;
    }
}

/* the passes of `disjoint` of topology.py: chosen (k); left (k), best and used (items) are room to work */
API void lamella_disjoint(Int k, Int width, const Int *touched, const Int *place, Int items, Int passes, Bool *chosen,
                          Int *left, Int *best, Bool *used)
{
    Int count = k;
    for (Int i = 0; i < k; i++) left[i] = i, chosen[i] = 0;
    for (Int i = 0; i < items; i++) used[i] = 0;
    for (Int pass = 0; pass < passes && count; pass++) {
        for (Int i = 0; i < items; i++) best[i] = k;
        for (Int l = 0; l < count; l++)
            for (Int j = 0; j < width; j++) {
                Int item = touched[width * left[l] + j];
                if (place[left[l]] < best[item]) best[item] = place[left[l]];
            }
        for (Int l = 0; l < count; l++) {
            const Int *mine = touched + width * left[l];
            Bool wins = 1;
            for (Int j = 0; j < width; j++) wins &= best[mine[j]] == place[left[l]];
            if (!wins) continue;
            chosen[left[l]] = 1;
            for (Int j = 0; j < width; j++) used[mine[j]] = 1;
        }
        Int still = 0;
        for (Int l = 0; l < count; l++) {
            Bool free = 1;
            for (Int j = 0; j < width; j++) free &= !used[touched[width * left[l] + j]];
            if (free) left[still++] = left[l];
        }
        count = still;
    }
}

/* the passes of `apart` of collapse.py: chosen (k); left (k), at_vertex, around and blocked (n) are room to work */
API void lamella_apart(Int n, Int m, const Int *faces, Int k, const Int *removed, const Int *kept, const Int *place,
                       Int passes, Bool *chosen, Int *left, Int *at_vertex, Int *around, Bool *blocked)
{
    Int count = k;
    for (Int i = 0; i < k; i++) left[i] = i, chosen[i] = 0;
    for (Int pass = 0; pass < passes && count; pass++) {
        for (Int v = 0; v < n; v++) at_vertex[v] = around[v] = k;
        for (Int l = 0; l < count; l++) {
            Int i = left[l];
            if (place[i] < at_vertex[removed[i]]) at_vertex[removed[i]] = place[i];
            if (place[i] < at_vertex[kept[i]]) at_vertex[kept[i]] = place[i];
        }
        for (Int f = 0; f < m; f++) {
            Int here = k;
            for (int j = 0; j < 3; j++)
                if (at_vertex[faces[3 * f + j]] < here) here = at_vertex[faces[3 * f + j]];
            for (int j = 0; j < 3; j++)
                if (here < around[faces[3 * f + j]]) around[faces[3 * f + j]] = here;
        }
        /* from here on the vertices of chosen collapses */
        for (Int v = 0; v < n; v++) at_vertex[v] = blocked[v] = 0;
        for (Int l = 0; l < count; l++) {
            Int i = left[l];
            if (around[removed[i]] == place[i] && around[kept[i]] == place[i]) chosen[i] = 1;
        }
        for (Int i = 0; i < k; i++)
            if (chosen[i]) at_vertex[removed[i]] = at_vertex[kept[i]] = 1;
        for (Int f = 0; f < m; f++) {
            const Int *v = faces + 3 * f;
            if (at_vertex[v[0]] || at_vertex[v[1]] || at_vertex[v[2]])
                for (int j = 0; j < 3; j++) blocked[v[j]] = 1;
        }
        Int still = 0;
        for (Int l = 0; l < count; l++)
            if (!blocked[removed[left[l]]] && !blocked[kept[left[l]]]) left[still++] = left[l];
        count = still;
    }
}

static int is_edge(Int e, const Int *keys, Int n, Int one, Int other)
{
    Int key = one < other ? one * n + other : other * n + one, low = 0, high = e;
    while (low < high) {
        Int middle = low + (high - low) / 2;
        if (keys[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low < e && keys[low] == key;
}

typedef struct {
    double pi, margin, bend, draft_shape, ear, bridge, half_up;
} Limits;

/* which diagonals `flip` of flip.py may exchange: their number, edges and gains */
API Int lamella_flips(Int n, Int e, const double *points, const Int *faces, const double *size, const Bool *boundary,
                      const Int *valence, const Int *keys, const Int *ends, const Int *halves, const double *angles,
                      const double *turn, const double *area, const double *normals, const double *shapes,
                      Int by_valence, Int bridges, const Limits *limits, Int *edges, double *gains)
{
    Int found = 0;
    double margin = limits->margin;
    for (Int edge = 0; edge < e; edge++) {
        Int one = halves[2 * edge], other = halves[2 * edge + 1];
        if (other < 0) continue;
        Int first = one / 3, second = other / 3;
        Int v[4] = {ends[2 * edge], ends[2 * edge + 1], faces[next_half(next_half(one))],
                    faces[next_half(next_half(other))]};
        Bool tip[4];
        for (int j = 0; j < 4; j++)
            tip[j] = boundary[v[j]] && valence[v[j]] == (j < 2 ? 3 : 2) && turn[v[j]] < limits->ear;
        Bool makes_ear = tip[0] || tip[1], spoils_ear = tip[2] || tip[3];
        double before = least(shapes[first], shapes[second]), gain;
        Bool wanted;
        if (by_valence) {
            double off[4];
            for (int j = 0; j < 4; j++)
                off[j] = (double)valence[v[j]] -
                         (boundary[v[j]] ? most(floor(turn[v[j]] / (limits->pi / 3) + limits->half_up), 1.0) + 1.0 : 6.0);
            gain = 2.0 * (off[0] + off[1] - off[2] - off[3] - 2.0);
            wanted = gain > 0;
        } else {
            gain = angles[next_half(next_half(one))] + angles[next_half(next_half(other))] - limits->pi;
            wanted = gain > margin || before < 0.05;
        }
        wanted = (wanted || makes_ear) && !spoils_ear;
        if (wanted && boundary[v[2]] && boundary[v[3]] && !makes_ear)
            wanted = bridges || is_narrow(points, size, limits->bridge, v[2], v[3]);
        if (!wanted || !(dot(normals + 3 * first, normals + 3 * second) > limits->bend || before < 0)) continue;
        if (is_edge(e, keys, n, v[2], v[3])) continue;
        double normal[3];
        const double *sum = before < 0 ? normals : area;
        for (int i = 0; i < 3; i++) normal[i] = sum[3 * first + i] + sum[3 * second + i];
        unit(normal, normal);
        const double *a = points + 3 * v[0], *b = points + 3 * v[1], *c = points + 3 * v[2], *d = points + 3 * v[3];
        double after = least(shape_towards(a, d, c, normal), shape_towards(d, b, c, normal));
        Bool keep = after > before + margin;
        if (makes_ear)
            keep = after > 0.1;
        else if (by_valence)
            keep = after > least(limits->draft_shape, before) + margin;
        else if (!(before < 0.05))
            keep = after > 0.05 * most(before, 0.0) && (gain > margin || keep);
        if (keep) {
            edges[found] = edge;
            gains[found++] = gain;
        }
    }
    return found;
}

/* the ways (n, 3) of `smooth` or, with a limit of shapes from 0 on, of `round_off` in smooth.py; total (n), normal
   (n, 3) and poor (n) are room to work */
API void lamella_ways(Int n, Int m, const double *points, const Int *faces, const double *size, const double *area,
                      const double *normals, const double *shapes, double limit, double step, double *way,
                      double *total, double *normal, Bool *poor)
{
    for (Int i = 0; i < 3 * n; i++) way[i] = 0.0;
    for (Int v = 0; v < n; v++) total[v] = 0.0, poor[v] = limit < 0;
    for (Int f = 0; f < m; f++)
        if (shapes[f] < limit) poor[faces[3 * f]] = poor[faces[3 * f + 1]] = poor[faces[3 * f + 2]] = 1;
    for (Int f = 0; f < m; f++) {
        const Int *v = faces + 3 * f;
        double weight, goals[3][3];
        if (limit < 0) {
            double mean = (size[v[0]] + size[v[1]] + size[v[2]]) / 3.0;
            weight = sqrt(dot(area + 3 * f, area + 3 * f)) / (mean * mean * mean);
            for (int i = 0; i < 3; i++)
                goals[0][i] = goals[1][i] = goals[2][i] =
                    (points[3 * v[0] + i] + points[3 * v[1] + i] + points[3 * v[2] + i]) / 3.0;
        } else {
            double short_of = 1.02 - most(shapes[f], 0.0);
            weight = poor[v[0]] || poor[v[1]] || poor[v[2]] ? short_of * short_of : 0.0;
            for (int j = 0; j < 3; j++) {
                const double *start = points + 3 * v[(j + 1) % 3], *end = points + 3 * v[(j + 2) % 3];
                double side[3], inward[3];
                less(end, start, side);
                cross(normals + 3 * f, side, inward);
                for (int i = 0; i < 3; i++) goals[j][i] = 0.5 * (start[i] + end[i]) + 0.5 * sqrt(3.0) * inward[i];
            }
        }
        for (int j = 0; j < 3; j++) {
            total[v[j]] += weight;
            for (int i = 0; i < 3; i++) way[3 * v[j] + i] += goals[j][i] * weight;
        }
    }
    vertex_normals(n, m, faces, area, normal);
    for (Int v = 0; v < n; v++) {
        double *there = way + 3 * v;
        for (int i = 0; i < 3; i++) there[i] = there[i] / (total[v] > 0 ? total[v] : 1.0) - points[3 * v + i];
        double along = dot(there, normal + 3 * v);
        for (int i = 0; i < 3; i++) there[i] = (there[i] - along * normal[3 * v + i]) * (poor[v] ? step : 0.0);
    }
}

/* `guarded` of smooth.py: goal (n, 3) and away (n) are changed; back (n) is room to work */
API void lamella_guarded(Int n, Int m, const double *points, const Int *faces, const double *shapes,
                         const double *normals, double good, double margin, double *goal, Bool *away, Bool *back)
{
    for (Bool any = 1; any;) {
        any = 0;
        for (Int v = 0; v < n; v++) back[v] = 0;
        for (Int f = 0; f < m; f++) {
            const Int *v = faces + 3 * f;
            double after = shape_towards(goal + 3 * v[0], goal + 3 * v[1], goal + 3 * v[2], normals + 3 * f);
            if (after < least(good, shapes[f]) - margin)
                for (int j = 0; j < 3; j++) back[v[j]] = 1;
        }
        for (Int v = 0; v < n; v++)
            if (back[v] && away[v]) {
                for (int i = 0; i < 3; i++) goal[3 * v + i] = points[3 * v + i];
                away[v] = 0;
                any = 1;
            }
    }
}
