# holds_but_open.sh - sourced by tests of folders of scenes. Every scene holds what it expects, but for what the folder's
# open.txt lists; and what is listed there still fails. So whoever mends one must take it off the list, and whoever breaks
# one sees it.

. tests/harness/trials.sh

# holds_but_open FOLDER LEAST [EVERY]: its scenes, of which there are at least so many, in float and double; of those in double one in
# EVERY, where TRIALS is less than that.
holds_but_open() {
    local bin=${PLUMB_BIN:-${O:-build}/plumb} folder=$1 least=$2 precision open=$1/open.txt scenes share
    [ -f "$open" ] || open=/dev/null
    for precision in float double; do
        share=1
        [ $precision = float ] || trials_at_least "${3:-1}" || share=${3:-1}
        mapfile -t scenes < <(ls "$folder"/*.lua | awk -v share=$share 'NR % share == 0')
        "$bin" check --quiet --precision $precision "${scenes[@]}" 2>/dev/null |
            awk -v precision=$precision -v share=$share -v least=$((least / share)) \
                -v taken=" $(basename -a "${scenes[@]}" | tr '\n' ' ')" '
                # "float,double | scene.lua | expectation | measured | cause"
                FILENAME != "-" {
                    if (/^#/ || split($0, field, / *[|] */) < 3 || index(field[1], precision) == 0) next
                    if (share > 1 && index(taken, " " field[2] " ") == 0) next
                    listed[field[2] "|" field[3]] = 1
                    next
                }
                !/^(ok|FAIL|none) / { next }
                {
                    status = $1
                    scene = $2
                    sub(/:$/, "", scene)
                    name = $0
                    sub(/^[^:]*: /, "", name)
                    if (!(scene in seen)) order[++scenes] = scene
                    seen[scene]++
                    open_one = ""
                    for (key in listed) {
                        what = substr(key, length(scene) + 2)
                        if (index(key, scene "|") == 1 && (name == what || index(name, what ": ") == 1)) open_one = key
                    }
                    if (open_one != "") {
                        met[open_one] = 1
                        opened[scene]++
                        if (status == "ok") wrong[scene] = wrong[scene] "; holds now, take it off the list: " name
                    } else if (status != "ok") {
                        wrong[scene] = wrong[scene] "; " name
                    }
                }
                END {
                    for (key in listed) {
                        if (!(key in met)) {
                            split(key, field, "|")
                            wrong[field[1]] = wrong[field[1]] "; listed, but not among its expectations: " field[2]
                            if (!(field[1] in seen)) { order[++scenes] = field[1]; seen[field[1]] = 0 }
                        }
                    }
                    for (i = 1; i <= scenes; i++) {
                        s = order[i]
                        printf "%s - %s %s: %d of %d hold%s\n", s in wrong ? "not ok" : "ok", precision, s,
                               seen[s] - opened[s], seen[s], wrong[s]
                    }
                    if (scenes < least) print "not ok - " precision ": only " scenes + 0 " scenes"
                }' "$open" -
    done
}
