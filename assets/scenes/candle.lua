-- candle.lua - smoke of a candle rises, and goes round a ball that hangs above it.
-- Shows: air{} with open sides, air_source{} of heat and smoke, an obstacle of any shape, what is carried and what is kept.
scene { title = "Candle", duration = 7, description = "Hot air carries smoke up and round a ball." }
camera { fit = {{-1.0, -0.02}, {1.0, 1.38}}, at = 7 }
body { type = "static", name = "table", box { 2.4, 0.08, at = {0, -0.04} }, color = 3 }
body { type = "static", name = "candle", box { 0.09, 0.26 }, at = {0, 0.13}, color = "#efe6d2" }
body { type = "static", name = "ball", circle { 0.13 }, at = {0.012, 0.78}, color = 6 }

-- For the eye: what glows. Sensors let air through.
body { type = "static", name = "flame", sensor = true, color = "#f6b73c",
       polygon { {0, 0.262}, {0.018, 0.285}, {0.016, 0.305}, {0, 0.35}, {-0.016, 0.305}, {-0.018, 0.285} } }

air { size = {2.5, 1.5}, at = {0, 0.75}, cell = param("cell", 0.02, 0.005, 0.05), bottom = "closed",
      cooling = 0.7, fading = 0.06 }
air_source { at = {0, 0.29}, radius = 0.035, heat = 3600, smoke = 34 }

-- Still: nothing has been blown at it; what moves is what is hot.
expect { "the plume has passed the ball on both sides", at = 7, test = function()
    local least = math.huge
    for side = -1, 1, 2 do
        local most = 0
        for x = 0.15, 0.6, 0.02 do
            local _, _, smoke = air_at(side * x, 0.8)
            most = math.max(most, smoke)
        end
        least = math.min(least, most)
    end
    return least > 0.05, least, 0.05
end }
