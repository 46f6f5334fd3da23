-- rocking_block.lua - a slender block let go on one corner: theta'' = -p^2 sin(alpha - theta), p^2 = 3 g / 4 R, by
-- Runge-Kutta; when it comes down on the other corner w+ / w- = 1 - 1.5 sin(alpha)^2.
-- Source: Housner, Bull. Seism. Soc. Am. 53 (1963) 403. Hard: a blow at the one corner while the other lifts, without
-- bounce; the corner must neither slip nor creep.
-- Aim: 1e-2 rad in three half periods.
scene { title = "Rocking block", duration = 2.2, description = "A block rocks from corner to corner." }
local g, w, h, start = 9.81, 0.4, 1.6, 0.15
local alpha, r = math.atan(w, h), math.sqrt(w * w + h * h) / 2
local p2, keeps = 3 * g / (4 * r), 1 - 1.5 * math.sin(alpha) * math.sin(alpha)
local rough = material { friction = 1 }
body { name = "ground", type = "static", box { 10, 1 }, at = {0, -0.5}, material = rough }
body { name = "block", box { w, h }, at = {w / 2 - r * math.sin(alpha - start), r * math.cos(alpha - start)}, angle = -start,
       material = rough, sleep = false }
-- Steps of 1/2400 s of the velocity Verlet, which halve where the block comes down.
local time, a, v, side = 0, start, 0, -1
local function tilt(t)
    if t < time then time, a, v, side = 0, start, 0, -1 end
    while time < t - 1e-12 do
        local step = math.min(1 / 2400, t - time)
        local function moved(k)
            local b = a + k * v - k * k / 2 * p2 * math.sin(alpha - a)
            return b, v - k / 2 * p2 * (math.sin(alpha - a) + math.sin(alpha - b))
        end
        local b, u = moved(step)
        if b < 0 then
            local low, high = 0, step
            for _ = 1, 40 do
                local mid = (low + high) / 2
                if moved(mid) < 0 then high = mid else low = mid end
            end
            step = high
            b, u = moved(step)
            b, u, side = 0, -keeps * u, -side
        end
        a, v, time = b, u, time + step
    end
    return side * a
end
exact { "angle", body = "block", angle = tilt, till = 2 }
exact { "first fall", body = "block", angle = tilt, till = 0.45 }
expect { "till it comes down", exact = "first fall", tolerance = 0.0017 }
expect { "three half periods", exact = "angle", tolerance = 0.15 }
