-- bonfire.lua - one log of a pile is lit: each warms those that it touches until they burn, too; they burn away, and
-- the stone that they bore comes down. Shows: heat through contacts, ignition, burning, glow; bodies that shrink and are gone.
scene { title = "Bonfire", duration = 50, description = "Logs light one another and burn away; the stone on them comes down." }
camera { fit = { {-2.2, -0.35}, {2.2, 2.5} }, at = 12 }
local bark = material { density = 600, friction = 0.7 }
body { type = "static", name = "hearth", color = "#6d6258", box { 8, 0.4, at = { 0, -0.2 } },
    box { 0.2, 0.5, at = { -1.32, 0.25 } }, box { 0.2, 0.5, at = { 1.32, 0.25 } } }

local r, logs, mass = 0.2, {}, 0
local rate = param("rate", 0.01, 0.002, 0.1)
for row = 0, 3 do
    for i = 0, 5 - row do
        local log = body { name = "log" .. #logs + 1, circle { r }, material = bark, color = "#8a6442",
            at = { (i - (5 - row) / 2) * 2.02 * r, r + row * 1.74 * r }, angle = i + row,
            temperature = 290, heat_capacity = 400, conductance = 8e3, emissivity = 0.9, ignition = 550,
            burn_rate = rate, burn_heat = 1.3e6, smallest = 0.06 }
        logs[#logs + 1], mass = log, mass + log:mass()
    end
end
body { name = "stone", box { 1, 0.4, round = 0.05 }, density = 1500, color = "#8b97a3", at = { 0, 1.7 } }
at(2, function() logs[#logs]:set_temperature(1300) end)

local lit, burnt = {}, 0
every(0.1, function(t)
    for i = 1, #logs do
        if not lit[i] and logs[i]:alive() and logs[i]:temperature() >= 550 then lit[i] = t end
    end
end)
on_gone { a = "log*", function(_, e) if e.how == "burnt" then burnt = burnt + 1 end end }
expect { "the fire goes from log to log", at = 50, test = function()
    local last, count = 0, 0
    for i = 1, #logs do
        count = count + (lit[i] and 1 or 0)
        last = math.max(last, lit[i] or 0)
    end
    return count >= 14 and last > 4, count, 14
end }
expect { "what was lit burns away", at = 50, test = function()
    local count = 0
    for i = 1, #logs do count = count + (lit[i] and 1 or 0) end
    return burnt == count, burnt, count
end }
expect { "what is gone was there", always = true, test = function()
    local left, h = 0, heat()
    for i = 1, #logs do left = left + (logs[i]:alive() and logs[i]:mass() or 0) end
    local off = math.abs(left - h.burnt + h.gone - mass)
    return off < 1e-3, off, 1e-3
end }
expect { "the stone lies on them first", body = "stone", from = 1, till = 4, y = { 1.5, 1.8 } }
expect { "the stone comes down", body = "stone", at = 50, y = { 0.15, 0.75 }, max_speed = 0.05 }
