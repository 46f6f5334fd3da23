-- tunnel_rods.lua - rods of 4 m by 2 cm that spin at 10 to 300 rad/s, and are thrown at posts of 5 cm and at a thin floor.
-- Fails: Jolt's cast of lines misses fast rotation (its documentation), Box2D and Rapier cap rotation instead.
-- Right: none passes: behind the posts there is no rod, below the floor neither.
-- lint: allow fast-and-thin: fast things are what it asks
scene { title = "Spinning rods", gravity = {0, 0}, duration = 2 }
body { type = "static", box { 400, 0.01 }, at = {0, -6} }
for i, w in ipairs { 10, 30, 100, 300 } do
    for j, v in ipairs { 5, 30, 100 } do
        body { name = ("rod%d_%d"):format(i, j), box { 4, 0.02 }, at = {(i * 3 + j) * 10 - 80, 0}, velocity = {0, -v}, spin = w,
               density = 1000 }
    end
end
body { name = "posts", type = "static", box { 0.05, 0.05, at = {100, 50} }, box { 0.05, 0.05, at = {100, 51} },
                    box { 0.05, 0.05, at = {100, 52} }, box { 0.05, 0.05, at = {100, 49} }, box { 0.05, 0.05, at = {100, 48} } }
body { name = "arrow", box { 0.02, 4 }, at = {90, 50}, velocity = {100, 0}, density = 1000 }
expect { "no rod is below the floor", always = true, body = "rod*", y = {-6, 1e4} }
expect { "the arrow does not pass the posts", always = true, body = "arrow", x = {-1e4, 100} }
